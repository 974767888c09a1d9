#include "analysis/diagnose/noise_level_curves.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/rarity.hpp"
#include "analysis/diagnose/repetition.hpp"

namespace gyrolog {

namespace {

constexpr std::size_t memory_blocks_least = 16;
constexpr double rhythm_step_s = 0.5;
constexpr double rhythm_samples_least = 16.0;
constexpr std::size_t rhythm_steps_least = 128;
// Most have no more: less is no news.
const double even_chance_nats = std::log(2.0);
// What one block may have: spikes are no rhythm.
constexpr double deviates_most = 4.0;

double square(double value) { return value * value; }

// Of the samples that are judged, in the order of time.
std::vector<double> squares_of(const Observation& observation, std::size_t axis) {
    const std::vector<float>& white = observation.axis(axis).whitened;
    std::vector<double> squares;
    squares.reserve(white.size());
    for (std::size_t slot = 0; slot < white.size(); ++slot) {
        if (observation.present()[slot]) { squares.push_back(square(static_cast<double>(white[slot]))); }
    }
    return squares;
}

struct Moments {
    double mean = 0.0;
    double variance = 0.0;
};

Moments moments_of(const std::vector<double>& values) {
    const auto count = static_cast<double>(std::max<std::size_t>(values.size(), 1));
    Moments moments;
    for (const double value : values) { moments.mean += value / count; }
    for (const double value : values) { moments.variance += square(value - moments.mean) / count; }
    return moments;
}

void fill_memory(const Observation& observation, std::vector<double> means, GapCurve& curve) {
    const double variance = moments_of(means).variance;
    // As many points for every observation, however many of its samples are to be judged.
    const std::size_t slots = observation.baseline().length();
    for (std::size_t length = 1; slots / length >= memory_blocks_least; length *= 2) {
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < means.size(); i += 2) {
            sum += square(means[i + 1] - means[i]);
            means[i / 2] = 0.5 * (means[i] + means[i + 1]);
        }
        const std::size_t pairs = means.size() / 2;
        means.resize(pairs);
        const double expected = 2.0 * variance / static_cast<double>(length) * static_cast<double>(pairs);
        curve.x.push_back(static_cast<double>(length) / observation.baseline().rate_hz());
        // Few pairs are far from normal; the cube root is nearer (see the spectrum's).
        curve.value.push_back(expected > 0.0 ? std::cbrt(sum / expected) - 1.0 : 0.0);
    }
}

// Means of the squares in blocks, as unit white noise; 0 where none of a block's samples is judged.
std::vector<float> levels(const Observation& observation, std::size_t axis, std::size_t length) {
    const std::vector<float>& white = observation.axis(axis).whitened;
    const std::size_t blocks = white.size() / length;
    const Moments all = moments_of(squares_of(observation, axis));
    std::vector<float> level(blocks, 0.0F);
    for (std::size_t block = 0; block < blocks; ++block) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t slot = block * length; slot < (block + 1) * length; ++slot) {
            if (!observation.present()[slot]) { continue; }
            sum += square(static_cast<double>(white[slot])) - all.mean;
            count += 1.0;
        }
        if (!(count > 0.0) || !(all.variance > 0.0)) { continue; }
        level[block] = static_cast<float>(
            std::clamp(sum / std::sqrt(count * all.variance), -deviates_most, deviates_most));
    }
    return level;
}

GapCurve of_all_axes(GapDomainKind kind, const Observation& observation) {
    const std::vector<std::size_t>& axes = observation.baseline().axes();
    GapCurve curve{kind, axes.front(), axes.front(), {}, {}};
    curve.of_all_axes = true;
    return curve;
}

}  // namespace

GapCurve memory_curve(const Observation& observation, std::size_t axis) {
    GapCurve curve{GapDomainKind::memory, axis, axis, {}, {}};
    fill_memory(observation, squares_of(observation, axis), curve);
    return curve;
}

GapCurve shared_memory_curve(const Observation& observation) {
    GapCurve curve = of_all_axes(GapDomainKind::memory, observation);
    std::vector<double> sum;
    for (const std::size_t axis : observation.baseline().axes()) {
        const std::vector<double> squares = squares_of(observation, axis);
        sum.resize(squares.size(), 0.0);
        for (std::size_t i = 0; i < sum.size(); ++i) { sum[i] += squares[i]; }
    }
    fill_memory(observation, std::move(sum), curve);
    return curve;
}

GapCurve rhythm_curve(const Observation& observation) {
    const Baseline& baseline = observation.baseline();
    GapCurve curve = of_all_axes(GapDomainKind::rhythm, observation);
    const auto length =
        static_cast<std::size_t>(std::max(rhythm_samples_least, rhythm_step_s * baseline.rate_hz()));
    if (baseline.length() / length < rhythm_steps_least) { return curve; }
    std::vector<std::vector<float>> series;
    for (const std::size_t axis : baseline.axes()) { series.push_back(levels(observation, axis, length)); }
    std::vector<Repetition> found = repetitions(series, static_cast<double>(length) / baseline.rate_hz());
    std::ranges::reverse(found);
    for (const Repetition& one : found) {
        curve.x.push_back(one.period_s);
        curve.value.push_back(deviate_of(std::max(one.evidence_nats, even_chance_nats)));
    }
    return curve;
}

}  // namespace gyrolog
