#include "analysis/diagnose/selection/repeating_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

#include "analysis/diagnose/selection/alternative_noise.hpp"
#include "analysis/numerics/cosine_transform.hpp"
#include "analysis/numerics/repetition.hpp"

namespace gyrolog::resolution {

// A period shorter than some seconds is a few lines that stand alone.
constexpr double block_s = 0.1;
constexpr std::size_t blocks_least = 64;
constexpr std::size_t course_blocks_most = 1'000'000;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

std::vector<float> whitened(const Observation& without, std::size_t axis,
                            const std::vector<double>& density) {
    const Prediction& prediction = without.prediction();
    std::vector<float> values(without.axis(axis).cosines);
    for (std::size_t i = 0; i < prediction.bins().size(); ++i) {
        const auto scale = static_cast<float>(1.0 / std::sqrt(density[i] * prediction.rate_hz()));
        for (std::size_t k = prediction.bins()[i].first; k < prediction.bins()[i].end; ++k) {
            values[k] *= scale;
        }
    }
    prediction.transform()->inverse(std::span<float>(values));
    return values;
}

// Sums of `length` neighbours, as unit white noise.
std::vector<float> block_sums(const std::vector<float>& samples, std::size_t length) {
    std::vector<float> sums(samples.size() / length);
    const float scale = 1.0F / std::sqrt(static_cast<float>(length));
    for (std::size_t block = 0; block < sums.size(); ++block) {
        float sum = 0.0F;
        for (std::size_t i = 0; i < length; ++i) { sum += samples[block * length + i]; }
        sums[block] = scale * sum;
    }
    return sums;
}

}  // namespace

std::optional<NonparametricFit> find_repeating_course(const Observation& without, const Observation& with) {
    const Prediction& prediction = without.prediction();
    const auto length =
        std::max<std::size_t>({1, static_cast<std::size_t>(resolution::block_s * prediction.rate_hz()),
                               prediction.length() / resolution::course_blocks_most});
    if (prediction.length() / length < resolution::blocks_least) { return std::nullopt; }
    std::vector<std::vector<float>> series;
    double lost_nats = 0.0;
    for (const std::size_t axis : prediction.axes()) {
        const AlternativeNoise noise = alternative_noise(without, with, axis);
        lost_nats += noise.lost_nats;
        series.push_back(block_sums(whitened(without, axis, noise.density), length));
    }
    const std::vector<Repetition> found =
        repetitions(series, static_cast<double>(length) / prediction.rate_hz());
    const Repetition best = *std::ranges::max_element(found, {}, &Repetition::evidence_nats);
    if (!(best.evidence_nats > 0.0)) { return std::nullopt; }
    std::array<char, 96> words{};
    (void)std::snprintf(words.data(), words.size(), "A course that repeats every %.4g s", best.period_s);
    return NonparametricFit{words.data(), best.evidence_nats - lost_nats};
}

}  // namespace gyrolog
