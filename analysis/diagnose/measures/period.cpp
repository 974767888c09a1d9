#include "analysis/diagnose/measures/period.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"
#include "analysis/numerics/square.hpp"
#include "analysis/numerics/tail_probability.hpp"

namespace gyrolog::resolution {

constexpr std::size_t period_least = 4;
constexpr std::size_t period_most = 4096;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

GapCurve period_curve(const Observation& observation, std::size_t axis) {
    const Prediction& prediction = observation.prediction();
    const AxisObservation& seen = observation.axis(axis);
    // The inverse transform of the whitened power is its autocorrelation, half a sample beside the whole
    // lags: two neighbours together are the one at the lag between them, seen through a slight low-pass.
    std::vector<float> correlation(seen.cosines.size(), 0.0F);
    for (std::size_t i = 0; i < prediction.bins().size(); ++i) {
        const double expected = seen.density[i] * prediction.rate_hz();
        for (std::size_t k = std::max<std::size_t>(prediction.bins()[i].first, 1);
             k < prediction.bins()[i].end; ++k) {
            const double power = square(static_cast<double>(seen.cosines[k])) / expected;
            // A drift or a line is none of this; of what comes back often, no multiple is seen by itself.
            correlation[k] = static_cast<float>(std::min(power, square(decisions.seen_sigma)) - 1.0);
        }
    }
    prediction.transform()->inverse(std::span<float>(correlation));
    for (std::size_t lag = correlation.size() - 1; lag > 0; --lag) {
        correlation[lag] += correlation[lag - 1];
    }
    const std::size_t lags = correlation.size() / 2;
    double squares = 0.0;
    for (std::size_t lag = resolution::period_least; lag < lags; ++lag) {
        squares += square(static_cast<double>(correlation[lag]));
    }
    const double sd = std::sqrt(squares / static_cast<double>(lags - resolution::period_least));
    GapCurve curve{&measures::period, axis, axis, {}, {}};
    for (std::size_t from = resolution::period_least; from < resolution::period_most; from *= 2) {
        if (static_cast<double>(lags) / static_cast<double>(2 * from) < decisions.repetitions_least()) {
            break;
        }
        double most = 0.0;
        for (std::size_t period = from; period < 2 * from; ++period) {
            double sum = 0.0;
            double multiples = 0.0;
            for (std::size_t lag = period; lag < lags; lag += period) {
                sum += static_cast<double>(correlation[lag]);
                multiples += 1.0;
            }
            most = std::max(most, sum / std::sqrt(multiples));
        }
        // Half the chance of either sign's square.
        const double surprise = surprise_of_largest(square(most / sd), 1.0, 0.5 * static_cast<double>(from));
        curve.x.push_back(static_cast<double>(from) * std::sqrt(2.0) / prediction.rate_hz());
        curve.value.push_back(deviate_of(surprise));
    }
    return curve;
}

}  // namespace

const Measure measures::period{.name = "periodicity",
                               .x_name = "period (s)",
                               .y_name = "excess (its sd)",
                               .shown_x = as_it_is,
                               .shown_y = as_it_is,
                               .locate = locate_period,
                               .log_x = true,
                               .is_of_noise = true};

void add_period_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    curves.push_back(period_curve(observation, axis));
}

}  // namespace gyrolog
