// Numbers in which a recording may differ from its simulations, by domain: what lies outside the simulations
// shows where the gap is, whatever its cause.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/diagnose/likelihood/observation.hpp"

namespace gyrolog {

enum class GapDomainKind {
    allan,
    spectrum,
    narrow,
    course,
    drift,
    amplitude,
    temperature,
    cross_axis,
    rate,
    rate_noise,
    acceleration,
    gain_course,
    delay_course,
    repeats,
    memory,
    rhythm,
    period,
    codes
};

// `value` is on a scale on which chance is nearly normal; x is SI.
struct GapCurve {
    GapDomainKind kind = GapDomainKind::spectrum;
    std::size_t axis = 0;
    std::size_t other = 0;  // cross_axis: the other axis; rate: the axis whose rate x is
    std::vector<double> x;
    std::vector<double> value;
    bool of_all_axes = false;
};

// Of one observation: the same curves, of as many points, for every observation of a prediction.
//   allan        ln of the Allan deviation of the residual over averaging times, over the model's
//   spectrum     ln of the power over the fitted density, thirds of octaves
//   course       ln of the whitened samples' variance over time
//   drift        mean of the whitened samples over time, in standard deviations
//   amplitude    ln of the share of whitened samples beyond x standard deviations
//   cross_axis   correlation of two axes by frequency
//   temperature, and of a sensor that moves rate, rate_noise, acceleration, gain_course, delay_course:
//                motion_curves.hpp
//   memory, rhythm: noise_level_curves.hpp
//   narrow, repeats, period, codes: structure_curves.hpp
std::vector<GapCurve> gap_curves(const Observation& observation);

}  // namespace gyrolog
