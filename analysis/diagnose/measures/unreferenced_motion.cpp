#include "analysis/diagnose/measures/unreferenced_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/numerics/square.hpp"
#include "analysis/recording/block_means.hpp"
#include "analysis/recording/neighbour_scatter.hpp"
#include "analysis/recording/recording_part.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/gyro_rest.hpp"

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

// From one second to the next, of a line that no plausible one is as large as.
double largest_swing_rad_s() {
    const auto params = find_effect("tone")->params;
    const auto amplitude = std::ranges::find(params, "amplitude_dps", &EffectParam::name);
    return 2.0 * decisions.beyond_plausible * amplitude->plausible_to * rad_per_deg;
}

// In seconds, or in rows where these are longer.
std::int64_t rows_of_second(const Recording& recording) {
    return std::max<std::int64_t>(1, std::llround(recording.rate_hz));
}

// Of a row.
double white_variance(const Recording& recording, const Column& column, const AxisModel& model) {
    std::vector<Segment> rest = segments_within(recording.segments, recording.rate_hz, gyro_rest(recording));
    if (rest.empty()) { rest = recording.segments; }
    return std::max(square(neighbour_scatter(column, rest, order_beside_motion)),
                    square(model.noise.N_rad_per_sqrt_s) * recording.rate_hz);
}

}  // namespace

bool seems_to_have_turned(const Observation& observation) {
    const Prediction& prediction = observation.prediction();
    return !prediction.moves() && std::ranges::any_of(prediction.axes(), [&](std::size_t axis) {
        const double white = prediction.parts(axis).back().sum();
        return second_to_second_variance(observation, axis) > decisions.square_of_motion * white;
    });
}

double share_turned(const Recording& recording, const SensorModel& model) {
    if (has_reference(recording)) { return 0.0; }
    std::set<std::int64_t> turned;
    std::size_t pairs = 0;
    for (std::size_t axis = 0; axis < gyro_columns.size(); ++axis) {
        const Column* column = recording.find(gyro_columns.at(axis));
        if (column == nullptr || column->unit != "rad/s") { continue; }
        const double white = white_variance(recording, *column, model.axes.at(axis));
        const std::vector<BlockMean> seconds =
            block_means(*column, recording.segments, rows_of_second(recording));
        std::size_t of_axis = 0;
        for (std::size_t i = 1; i < seconds.size(); ++i) {
            const BlockMean& before = seconds[i - 1];
            const BlockMean& second = seconds[i];
            if (second.index != before.index + 1) { continue; }
            ++of_axis;
            const double by_noise =
                white / static_cast<double>(before.samples) + white / static_cast<double>(second.samples);
            const double least =
                std::max(square(largest_swing_rad_s()), decisions.square_of_motion * by_noise);
            if (square(second.mean - before.mean) > least) { turned.insert(second.index); }
        }
        pairs = std::max(pairs, of_axis);
    }
    return pairs == 0 ? 0.0 : static_cast<double>(turned.size()) / static_cast<double>(pairs);
}

}  // namespace gyrolog
