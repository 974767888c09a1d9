#include "analysis/diagnose/measures/unreferenced_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/diagnose/decision_options.hpp"

namespace gyrolog {

namespace {

// The Allan variance at a second.
double second_to_second_variance(const Observation& observation, std::size_t axis) {
    const std::vector<float>& residual = observation.axis(axis).residual_rad_s;
    const auto second =
        static_cast<std::size_t>(std::max(1.0, std::round(observation.prediction().rate_hz())));
    double before = 0.0;
    double squares = 0.0;
    std::size_t seconds = 0;
    for (; (seconds + 1) * second <= residual.size(); ++seconds) {
        const auto from = residual.begin() + static_cast<std::ptrdiff_t>(seconds * second);
        const double mean = std::accumulate(from, from + static_cast<std::ptrdiff_t>(second), 0.0) /
                            static_cast<double>(second);
        if (seconds > 0) { squares += 0.5 * (mean - before) * (mean - before); }
        before = mean;
    }
    return seconds > 1 ? squares / static_cast<double>(seconds - 1) : 0.0;
}

}  // namespace

bool seems_to_have_turned(const Observation& observation) {
    const Prediction& prediction = observation.prediction();
    return !prediction.moves() && std::ranges::any_of(prediction.axes(), [&](std::size_t axis) {
        const double white = prediction.parts(axis).back().sum();
        return second_to_second_variance(observation, axis) > decisions.square_of_motion * white;
    });
}

}  // namespace gyrolog
