#include "analysis/diagnose/likelihood/variance_fit.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"

namespace gyrolog::resolution {

// Blocks on either side whose mean variance is the level around one.
constexpr std::size_t blocks_around = 8;
// Sums of neighbouring blocks, by powers of two, of which so many tell how they scatter.
constexpr std::size_t sums_least = 16;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

std::vector<double> level_around(const WhitenedBlocks& blocks) {
    std::vector<double> level;
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        double weight = 0.0;
        double sum = 0.0;
        for (std::size_t i = block < resolution::blocks_around ? 0 : block - resolution::blocks_around;
             i < std::min(block + resolution::blocks_around + 1, blocks.size()); ++i) {
            weight += blocks.weight[i];
            sum += blocks.weight[i] * blocks.variance[i];
        }
        level.push_back(weight > 0.0 ? std::sqrt(sum / weight) : 0.0);
    }
    return level;
}

}  // namespace

WhitenedBlocks joined(const WhitenedBlocks& blocks, std::size_t at_most) {
    const std::size_t each = (blocks.size() + at_most - 1) / at_most;
    if (each <= 1) { return blocks; }
    WhitenedBlocks fewer;
    fewer.length = blocks.length * each;
    fewer.level = blocks.level;
    for (std::size_t first = 0; first < blocks.size(); first += each) {
        double weight = 0.0;
        double sum = 0.0;
        for (std::size_t i = first; i < std::min(first + each, blocks.size()); ++i) {
            weight += blocks.weight[i];
            sum += blocks.weight[i] * blocks.variance[i];
        }
        fewer.weight.push_back(weight);
        fewer.variance.push_back(weight > 0.0 ? sum / weight : 0.0);
        fewer.mean.push_back(0.0);
    }
    return fewer;
}

double course_gain_nats(const WhitenedBlocks& blocks, std::span<const double> level) {
    double weight = 0.0;
    double plain = 0.0;
    double scaled = 0.0;
    double logs = 0.0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const double n = blocks.weight[i];
        if (n == 0.0) { continue; }
        weight += n;
        plain += n * blocks.variance[i];
        scaled += n * blocks.variance[i] / level[i];
        logs += n * std::log(level[i]);
    }
    if (!(plain > 0.0)) { return 0.0; }
    return 0.5 * (weight * std::log(plain / scaled) - logs);
}

double unit_level(const WhitenedBlocks& blocks, std::span<const double> level) {
    double weight = 0.0;
    double scaled = 0.0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        weight += blocks.weight[i];
        scaled += blocks.weight[i] * blocks.variance[i] / level[i];
    }
    return weight > 0.0 ? std::sqrt(scaled / weight) : 0.0;
}

double overdispersion(const WhitenedBlocks& blocks, std::span<const double> level) {
    const double unit = unit_level(blocks, level);
    std::vector<double> weights;
    std::vector<double> off;  // weighted
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (blocks.weight[i] == 0.0) { continue; }
        weights.push_back(blocks.weight[i]);
        off.push_back(blocks.weight[i] * (blocks.variance[i] / (level[i] * unit * unit) - 1.0));
    }
    double largest = 1.0;
    // What wanders slowly scatters no more from block to block than chance, but in sums of many.
    for (std::size_t each = 1; each == 1 || weights.size() / each >= resolution::sums_least; each *= 2) {
        const std::size_t sums = weights.size() / each;
        if (sums < 2) { break; }
        double scatter = 0.0;
        for (std::size_t k = 0; k < sums; ++k) {
            double weight = 0.0;
            double sum = 0.0;
            for (std::size_t i = k * each; i < (k + 1) * each; ++i) { weight += weights[i], sum += off[i]; }
            scatter += 0.5 * sum * sum / weight;
        }
        const auto count = static_cast<double>(sums);
        const double dispersion = scatter / (count - 1.0);
        if (dispersion > 1.0 + decisions.certain_sigma * std::sqrt(2.0 / count)) {
            largest = std::max(largest, dispersion);
        }
    }
    return largest;
}

double tails_beside(const WhitenedBlocks& blocks, const Observation& observation, std::size_t axis,
                    double model_nu) {
    if (!std::isinf(model_nu)) { return model_nu; }
    const std::vector<double> scale = level_around(blocks);
    const WhitenedHistogram histogram = whitened_histogram(blocks, observation, axis, scale);
    // Outliers are no tails: what lies where hardly any sample of the distribution does is left out.
    double samples = 0.0;
    double squares = 0.0;
    double fourths = 0.0;
    for (std::size_t i = 0; i < histogram.at.size(); ++i) {
        if (histogram.at[i] > decisions.outlier_sigma) { continue; }
        const double square = histogram.at[i] * histogram.at[i];
        samples += histogram.count[i];
        squares += histogram.count[i] * square;
        fourths += histogram.count[i] * square * square;
    }
    if (!(squares > 0.0)) { return model_nu; }
    const double excess = fourths * samples / (squares * squares) - 3.0;
    if (excess < decisions.certain_sigma * std::sqrt(24.0 / samples)) { return model_nu; }
    // Student's t has the excess kurtosis 6 / (nu - 4).
    return 4.0 + 6.0 / excess;
}

}  // namespace gyrolog
