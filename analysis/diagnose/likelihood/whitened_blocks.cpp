#include "analysis/diagnose/likelihood/whitened_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/diagnose/decision_options.hpp"

namespace gyrolog::resolution {

constexpr std::size_t blocks_most = 4096;
constexpr std::size_t block_least = 64;
constexpr std::size_t samples_least = 16;       // in a block that is judged
constexpr std::size_t usual_blocks_beside = 4;  // blocks on either side that tell what is usual
constexpr double bins_per_sigma = 64.0;
constexpr std::size_t bin_count = 512;  // up to 8 sigma
// Below this part of what the model expects there is no noise.
constexpr double dead_level = 1e-3;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Calls take(value) for every sample of a block.
template <typename Take>
void for_each_sample(const Observation& observation, std::size_t axis, std::size_t begin, std::size_t end,
                     Take take) {
    const std::vector<float>& whitened = observation.axis(axis).whitened;
    const std::vector<bool>& present = observation.present();
    for (std::size_t slot = begin; slot < end; ++slot) {
        if (present[slot]) { take(static_cast<double>(whitened[slot])); }
    }
}

struct Moments {
    double count = 0.0;
    double mean = 0.0;
    double variance = 0.0;
    double furthest = 0.0;  // from zero
};

// Of samples within `limit` of `middle`.
Moments moments_of(const Observation& observation, std::size_t axis, std::size_t begin, std::size_t end,
                   double middle = 0.0, double limit = std::numeric_limits<double>::infinity()) {
    double sum = 0.0;
    double squares = 0.0;
    Moments moments;
    for_each_sample(observation, axis, begin, end, [&](double w) {
        const double off = std::fabs(w - middle);
        if (!(off <= limit)) { return; }
        moments.count += 1.0;
        sum += w;
        squares += w * w;
        moments.furthest = std::max(moments.furthest, std::fabs(w));
    });
    if (moments.count < static_cast<double>(resolution::samples_least)) { return {}; }
    moments.mean = sum / moments.count;
    moments.variance = std::max(0.0, (squares - sum * moments.mean) / (moments.count - 1.0));
    return moments;
}

double median_of(std::vector<double>& values) {
    if (values.empty()) { return 0.0; }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Median variance of the blocks around one.
double usual_variance(const WhitenedBlocks& blocks, std::size_t block) {
    std::vector<double> near;
    for (std::size_t i = block < resolution::usual_blocks_beside ? 0
                                                                 : block - resolution::usual_blocks_beside;
         i < std::min(block + resolution::usual_blocks_beside + 1, blocks.size()); ++i) {
        if (blocks.weight[i] > 0.0) { near.push_back(blocks.variance[i]); }
    }
    return median_of(near);
}

std::size_t end_of(const WhitenedBlocks& blocks, const Observation& observation, std::size_t block) {
    // What is left over belongs to the last block.
    return block + 1 == blocks.size() ? observation.prediction().length() : (block + 1) * blocks.length;
}

}  // namespace

std::size_t WhitenedBlocks::length_for(std::size_t slots) {
    return std::max(resolution::block_least, slots / resolution::blocks_most);
}

bool WhitenedBlocks::has_noise() const { return level > resolution::dead_level && std::isfinite(level); }

WhitenedBlocks whitened_blocks(const Observation& observation, std::size_t axis) {
    const std::size_t slots = observation.prediction().length();
    WhitenedBlocks blocks;
    blocks.length = WhitenedBlocks::length_for(slots);
    const std::size_t count = slots / blocks.length;
    blocks.mean.resize(count);
    blocks.variance.resize(count);
    blocks.weight.resize(count);
    std::vector<double> furthest(count);
    const auto put = [&](std::size_t block, const Moments& moments) {
        blocks.mean[block] = moments.mean;
        blocks.variance[block] = moments.variance;
        blocks.weight[block] = std::max(0.0, moments.count - 1.0);
        furthest[block] = moments.furthest;
    };
    for (std::size_t block = 0; block < count; ++block) {
        put(block, moments_of(observation, axis, block * blocks.length, end_of(blocks, observation, block)));
    }
    std::vector<std::pair<std::size_t, Moments>> mended;
    for (std::size_t block = 0; block < count; ++block) {
        const double limit = decisions.outlier_sigma * std::sqrt(usual_variance(blocks, block));
        // A first pass that any outlier fails.
        if (furthest[block] + std::fabs(blocks.mean[block]) <= limit || !(limit > 0.0)) { continue; }
        // A single large one moves the mean by its own part of the block.
        const Moments core = moments_of(observation, axis, block * blocks.length,
                                        end_of(blocks, observation, block), 0.0, limit);
        mended.emplace_back(block, moments_of(observation, axis, block * blocks.length,
                                              end_of(blocks, observation, block), core.mean, limit));
    }
    for (const auto& [block, moments] : mended) { put(block, moments); }
    std::vector<double> judged;
    for (std::size_t block = 0; block < count; ++block) {
        if (blocks.weight[block] > 0.0) { judged.push_back(blocks.variance[block]); }
    }
    blocks.level = std::sqrt(median_of(judged));
    return blocks;
}

WhitenedBlocks with_tails(const WhitenedBlocks& blocks, const Observation& observation, std::size_t axis,
                          double nu) {
    if (std::isinf(nu)) { return blocks; }
    WhitenedBlocks tailed = blocks;
    std::vector<double> squares;
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        if (blocks.weight[block] == 0.0) { continue; }
        squares.clear();
        for_each_sample(observation, axis, block * blocks.length, end_of(blocks, observation, block),
                        [&](double w) {
                            const double off = w - blocks.mean[block];
                            squares.push_back(off * off);
                        });
        // EM: every sample's weight is its expected precision.
        double variance = blocks.variance[block];
        for (int iteration = 0; iteration < 6 && variance > 0.0; ++iteration) {
            double sum = 0.0;
            for (const double square : squares) {
                sum += (nu + 1.0) * square / (nu - 2.0 + square / variance);
            }
            variance = sum / static_cast<double>(squares.size() - 1);
        }
        tailed.variance[block] = variance;
        tailed.weight[block] = static_cast<double>(squares.size() - 1) * nu / (nu + 3.0);
    }
    return tailed;
}

double WhitenedHistogram::moment(int order) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i) { sum += count[i] * std::pow(at[i], order); }
    return samples > 0.0 ? sum / samples : 0.0;
}

double WhitenedHistogram::excess_kurtosis() const {
    const double variance = moment(2);
    return variance > 0.0 ? moment(4) / (variance * variance) - 3.0 : 0.0;
}

WhitenedHistogram whitened_histogram(const WhitenedBlocks& blocks, const Observation& observation,
                                     std::size_t axis, const std::vector<double>& scale) {
    WhitenedHistogram histogram;
    std::vector<std::size_t> counts(resolution::bin_count, 0);
    std::vector<double> beyond;
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        const double n = blocks.weight[block] + 1.0;
        const double unit = scale.empty() ? blocks.level : scale[block];
        if (blocks.weight[block] == 0.0 || !(unit > 0.0)) { continue; }
        const double factor = std::sqrt(n / (n - 1.0)) / unit;
        for_each_sample(observation, axis, block * blocks.length, end_of(blocks, observation, block),
                        [&](double w) {
                            const double off = std::fabs(w - blocks.mean[block]) * factor;
                            const double place = off * resolution::bins_per_sigma;
                            if (place < static_cast<double>(resolution::bin_count)) {
                                ++counts[static_cast<std::size_t>(place)];
                            } else {
                                beyond.push_back(off);
                            }
                        });
    }
    for (std::size_t i = 0; i < counts.size(); ++i) {
        histogram.at.push_back((static_cast<double>(i) + 0.5) / resolution::bins_per_sigma);
    }
    histogram.at.insert(histogram.at.end(), beyond.begin(), beyond.end());
    histogram.count.assign(counts.begin(), counts.end());
    histogram.count.resize(histogram.at.size(), 1.0);
    histogram.samples = std::accumulate(histogram.count.begin(), histogram.count.end(), 0.0);
    return histogram;
}

}  // namespace gyrolog
