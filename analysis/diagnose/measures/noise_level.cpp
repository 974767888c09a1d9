#include "analysis/diagnose/measures/noise_level.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"
#include "analysis/numerics/repetition.hpp"
#include "analysis/numerics/square.hpp"
#include "analysis/numerics/tail_probability.hpp"

namespace gyrolog::resolution {

constexpr std::size_t memory_blocks_least = 16;
constexpr double rhythm_step_s = 0.5;
constexpr double rhythm_samples_least = 16.0;
constexpr std::size_t rhythm_steps_least = 128;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Most have no more: less is no news.
const double even_chance_nats = std::log(2.0);

// Of the samples that are judged, in the order of time.
std::vector<float> squares_of(const Observation& observation, std::size_t axis) {
    const std::vector<float>& white = observation.axis(axis).whitened;
    std::vector<float> squares(white.size());
    if (std::ranges::find(observation.present(), false) == observation.present().end()) {
        std::ranges::transform(white, squares.begin(), [](float value) { return value * value; });
        return squares;
    }
    std::size_t known = 0;
    for (std::size_t slot = 0; slot < white.size(); ++slot) {
        squares[known] = white[slot] * white[slot];
        known += std::size_t{observation.present()[slot]};
    }
    squares.resize(known);
    return squares;
}

struct Moments {
    double mean = 0.0;
    double variance = 0.0;
};

Moments moments_of(const std::vector<float>& values) {
    const Eigen::Map<const Eigen::ArrayXf> all(values.data(), static_cast<Eigen::Index>(values.size()));
    if (values.empty()) { return {}; }
    // The squares of unit noise are about one: no digits are lost in the difference.
    const double mean = all.cast<double>().mean();
    return {mean, all.cast<double>().square().mean() - mean * mean};
}

void fill_memory(const Observation& observation, std::vector<float> means, double variance, GapCurve& curve) {
    // As many points for every observation, however many of its samples are to be judged.
    const std::size_t slots = observation.prediction().length();
    for (std::size_t length = 1; slots / length >= resolution::memory_blocks_least; length *= 2) {
        const std::size_t pairs = means.size() / 2;
        double sum = 0.0;
        for (std::size_t i = 0; i < pairs; ++i) {
            const float first = means[2 * i];
            const float second = means[2 * i + 1];
            sum += square(static_cast<double>(second - first));
            means[i] = 0.5F * (first + second);
        }
        means.resize(pairs);
        const double expected = 2.0 * variance / static_cast<double>(length) * static_cast<double>(pairs);
        curve.x.push_back(static_cast<double>(length) / observation.prediction().rate_hz());
        // Few pairs are far from normal; the cube root is nearer (see the spectrum's).
        curve.value.push_back(expected > 0.0 ? std::cbrt(sum / expected) - 1.0 : 0.0);
    }
}

// Means of the squares in blocks, as unit white noise; 0 where none of a block's samples is judged.
std::vector<float> levels(const Observation& observation, const std::vector<float>& squares,
                          const Moments& all, std::size_t length) {
    std::vector<float> level(observation.prediction().length() / length, 0.0F);
    const std::vector<bool>& present = observation.present();
    const bool is_whole = squares.size() == observation.prediction().length();
    std::size_t next = 0;
    for (std::size_t block = 0; block < level.size(); ++block) {
        const auto first = present.begin() + static_cast<std::ptrdiff_t>(block * length);
        const auto known = is_whole ? length
                                    : static_cast<std::size_t>(std::count(
                                          first, first + static_cast<std::ptrdiff_t>(length), true));
        float sums = 0.0F;
        for (std::size_t i = next; i < next + known; ++i) { sums += squares[i]; }
        next += known;
        const auto sum = static_cast<double>(sums);
        const auto count = static_cast<double>(known);
        if (!(count > 0.0) || !(all.variance > 0.0)) { continue; }
        const double deviates = (sum - count * all.mean) / std::sqrt(count * all.variance);
        // A block may have no more: spikes are no rhythm.
        level[block] =
            static_cast<float>(std::clamp(deviates, -decisions.certain_sigma, decisions.certain_sigma));
    }
    return level;
}

GapCurve of_all_axes(const Measure& measure, const Observation& observation) {
    const std::vector<std::size_t>& axes = observation.prediction().axes();
    GapCurve curve{&measure, axes.front(), axes.front(), {}, {}};
    curve.of_all_axes = axes.size() > 1;
    return curve;
}

GapCurve rhythm_curve(const Observation& observation, const std::vector<std::vector<float>>& series,
                      double step_s) {
    GapCurve curve = of_all_axes(measures::rhythm, observation);
    std::vector<Repetition> found = repetitions(series, step_s);
    std::ranges::reverse(found);
    for (const Repetition& one : found) {
        curve.x.push_back(one.period_s);
        curve.value.push_back(deviate_of(std::max(one.evidence_nats, even_chance_nats)));
    }
    return curve;
}

}  // namespace

const Measure measures::memory{.name = "bursts of noise",
                               .x_name = "length (s)",
                               .y_name = "over the model (dB)",
                               .shown_x = as_it_is,
                               .shown_y = cube_root_dB,
                               .locate = locate_averaging_times,
                               .log_x = true,
                               .shared_name = "shared ",
                               .is_of_noise = true};
const Measure measures::rhythm{.name = "rhythm of the noise",
                               .x_name = "period (s)",
                               .y_name = "excess (its sd)",
                               .shown_x = as_it_is,
                               .shown_y = as_it_is,
                               .locate = locate_period,
                               .log_x = true,
                               .least_sd = 1.0,
                               .is_of_noise = true};

void add_noise_level_curves(const Observation& observation, std::vector<GapCurve>& curves) {
    const Prediction& prediction = observation.prediction();
    const auto length = static_cast<std::size_t>(
        std::max(resolution::rhythm_samples_least, resolution::rhythm_step_s * prediction.rate_hz()));
    const bool has_rhythm = prediction.length() / length >= resolution::rhythm_steps_least;
    std::vector<std::vector<float>> series;
    std::vector<float> sum;
    for (const std::size_t axis : prediction.axes()) {
        std::vector<float> squares = squares_of(observation, axis);
        const Moments all = moments_of(squares);
        sum.resize(squares.size(), 0.0F);
        for (std::size_t i = 0; i < sum.size(); ++i) { sum[i] += squares[i]; }
        if (has_rhythm) { series.push_back(levels(observation, squares, all, length)); }
        curves.push_back({&measures::memory, axis, axis, {}, {}});
        fill_memory(observation, std::move(squares), all.variance, curves.back());
    }
    if (prediction.axes().size() > 1) {
        curves.push_back(of_all_axes(measures::memory, observation));
        const double variance = moments_of(sum).variance;
        fill_memory(observation, std::move(sum), variance, curves.back());
    }
    if (has_rhythm) {
        curves.push_back(
            rhythm_curve(observation, series, static_cast<double>(length) / prediction.rate_hz()));
    }
}

}  // namespace gyrolog
