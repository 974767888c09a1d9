// What a denoised rate errs by against a reference: what the filter does to the motion, and noise.
//
//   y_k = offset + gain r(t_k - lag) + noise
//
// by least squares: the whole lag with the least residual and a gain above 0 (of two that differ by less than
// a thousandth of it, as a period of a swing makes them, the shorter), then r and its change per sample about
// it, which shifts it by a fraction: r(t - lag - x) = r(t - lag) - x r'(t - lag). The reference's own noise
// counts as noise.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct MotionError {
    double lag_s = 0.0;
    double gain = 1.0;
    double offset = 0.0;
    double error_variance = 0.0;   // of y - r: what a user gets
    double motion_variance = 0.0;  // of offset + gain r(t - lag) - r: lag and gain
    double noise_variance = 0.0;   // of what is left
    std::size_t samples = 0;
};

// Rows where the reference or the rate is NaN are left out, and as many samples at either end of a segment
// as the longest lag that is looked for. Nothing when there are fewer than 100 others or the reference does
// not move.
std::optional<MotionError> motion_error(std::span<const double> rate, std::span<const double> reference,
                                        std::span<const Segment> segments, double rate_hz,
                                        double longest_lag_s);

}  // namespace gyrolog
