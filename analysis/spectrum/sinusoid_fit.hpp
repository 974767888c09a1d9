// Least squares of one sinusoid.
#pragma once

#include <optional>
#include <span>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct SinusoidFit {
    double f_hz = 0.0;
    double f_sd_hz = 0.0;
    double amplitude = 0.0;  // unit of the column
    double amplitude_sd = 0.0;
    double misfit =
        0.0;  // mean square of what is left of the sinusoid's blocks, over what noise leaves; 1 is right
};

// A sin(2 pi f t + phase) beside a straight line in every block of some periods, f within f_hz +- reach_hz,
// at the samples' true times. `noise_density`: two-sided, around f. Standard deviations: Cramer-Rao bounds
//   var A = 2 s^2 / n,   var f = 2 s^2 / (A^2 sum (2 pi (t - mean t))^2),   s^2 = noise density * rate
// (Kay 1993, eq. 3.41, which is the second for n samples without a hole). Nothing where no segment holds a
// block.
std::optional<SinusoidFit> fit_sinusoid(const Column& column, std::span<const Segment> segments,
                                        double rate_hz, double f_hz, double reach_hz, double noise_density);

}  // namespace gyrolog
