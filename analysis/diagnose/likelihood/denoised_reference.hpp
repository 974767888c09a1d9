// A denoised reference is a moving world with less of its reference's noise.
#pragma once

#include <memory>

#include "analysis/simulate/recorded_world.hpp"

namespace gyrolog {

// Every sample of the reference rate moves towards a straight line through its neighbours, the more so the
// nearer their scatter about it is to white noise of `noise_sd_rad_s` a sample: all the way at rest, hardly
// where the motion is fast (the local estimate of J.-S. Lee, IEEE Trans. PAMI 2 (1980) 165). Frequencies
// beyond the motion's are taken off. The rate of a reference orientation stays as it is.
std::shared_ptr<const RecordedWorld> without_reference_noise(const RecordedWorld& world,
                                                             double noise_sd_rad_s);

}  // namespace gyrolog
