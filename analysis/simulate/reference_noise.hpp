// Noise of an instrument that a gyro is judged by.
#pragma once

#include <array>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct ReferenceNoise {
    // One sigma of white noise of a row of ref_x, ref_y and ref_z in rad/s. 0 for an axis that has no
    // reference in rad/s, or one whose noise is not seen beside the gyro's.
    std::array<double, 3> sd_rad_s{};
    // All rows tell the variance of gyro and reference together no better than the rest tells the share of
    // the reference in it, on any axis.
    bool is_known_well = true;

    // The root of the mean square over the axes that have noise.
    double of_all_rad_s() const;
};

// The noise of the samples (third differences, neighbour_scatter.hpp) where the gyro rests (gyro_rest.hpp).
// None where there is no rest.
ReferenceNoise reference_noise_at_rest(const Recording& recording);

}  // namespace gyrolog
