// The white share is the part of an axis' whitened samples that is the sensor's white noise. Effects on the
// white noise act on that part alone.
#pragma once

#include <cstddef>

#include "analysis/diagnose/likelihood/observation.hpp"

namespace gyrolog {

struct WhiteShare {
    double variance = 1.0;  // of a whitened sample's
    // The variance of the white noise of a whitened sample's own instant; the rest is of other instants and
    // other noise.
    double own_variance = 1.0;
    double lattice = 0.0;  // the model's converter step in the unit of whitened samples
};

WhiteShare white_share(const Prediction& prediction, std::size_t axis);

// By how much one sample off by 1 rad/s raises its whitened one, as the observation's own noise has it:
// samples that are off raise that as well.
double whitened_per_rad_s(const Observation& observation, std::size_t axis);

// What it costs the model, in nats, that the axis' white noise has `level` times the standard deviation that
// the observation's nuisance gives it: by how much N then lies outside its stated uncertainty.
double level_cost_nats(const Observation& observation, std::size_t axis, double level);

}  // namespace gyrolog
