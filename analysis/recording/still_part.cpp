#include "analysis/recording/still_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gyrolog {
namespace {

constexpr double block_s = 1.0;
constexpr std::size_t block_samples_least = 16;
constexpr std::size_t blocks_wanted = 20;
constexpr std::size_t blocks_least = 4;
constexpr double quiet_factor = 2.0;
constexpr double step_factor = 6.0;
constexpr double drift_share = 0.5;  // of the quiet standard deviation, from one block to the next

struct Block {
    std::size_t first = 0;
    std::size_t count = 0;
    std::int64_t index = 0;  // on the grid, of its first sample
    std::vector<double> mean;
    std::vector<double> sd;
};

Block block_of(std::span<const std::vector<double>> signals, std::size_t first, std::size_t count,
               std::int64_t index) {
    Block block{first, count, index, {}, {}};
    for (const std::vector<double>& signal : signals) {
        double sum = 0.0;
        double squares = 0.0;
        const double origin = signal[first];
        for (std::size_t i = first; i < first + count; ++i) {
            sum += signal[i] - origin;
            squares += (signal[i] - origin) * (signal[i] - origin);
        }
        const auto n = static_cast<double>(count);
        block.mean.push_back(origin + sum / n);
        block.sd.push_back(std::sqrt(std::max(0.0, squares / n - sum / n * sum / n)));
    }
    return block;
}

std::vector<Block> blocks_of(const Recording& recording, std::span<const std::vector<double>> signals) {
    std::size_t size = std::max(block_samples_least, static_cast<std::size_t>(block_s * recording.rate_hz));
    size = std::max(block_samples_least, std::min(size, recording.rows() / blocks_wanted));
    std::vector<Block> blocks;
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i + size <= segment.count; i += size) {
            blocks.push_back(block_of(signals, segment.first + i, size,
                                      segment.first_index + static_cast<std::int64_t>(i)));
        }
    }
    return blocks;
}

std::vector<double> quiet_sds(const std::vector<Block>& blocks, std::size_t signals) {
    std::vector<double> quiet(signals);
    std::vector<double> sds(blocks.size());
    for (std::size_t s = 0; s < signals; ++s) {
        std::ranges::transform(blocks, sds.begin(), [&](const Block& block) { return block.sd[s]; });
        const auto decile = sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 10);
        std::nth_element(sds.begin(), decile, sds.end());
        quiet[s] = *decile;
    }
    return quiet;
}

bool is_quiet(const Block& block, const std::vector<double>& quiet) {
    for (std::size_t s = 0; s < quiet.size(); ++s) {
        if (block.sd[s] > quiet_factor * quiet[s]) { return false; }
    }
    return true;
}

bool goes_on(const Block& before, const Block& block, const std::vector<double>& quiet) {
    for (std::size_t s = 0; s < quiet.size(); ++s) {
        const double error =
            quiet[s] * (std::sqrt(2.0 / static_cast<double>(block.count)) + drift_share / step_factor);
        if (std::abs(block.mean[s] - before.mean[s]) > step_factor * error) { return false; }
    }
    return true;
}

}  // namespace

TimeSpan still_part(const Recording& recording, std::span<const std::vector<double>> signals) {
    const std::vector<Block> blocks = blocks_of(recording, signals);
    if (blocks.size() < blocks_least) { return {}; }
    const std::vector<double> quiet = quiet_sds(blocks, signals.size());
    std::size_t best_begin = 0;
    std::size_t best = 0;
    std::size_t run = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (!is_quiet(blocks[i], quiet)) {
            run = 0;
            continue;
        }
        run = run > 0 && goes_on(blocks[i - 1], blocks[i], quiet) ? run + 1 : 1;
        if (run > best) {
            best = run;
            best_begin = i + 1 - run;
        }
    }
    if (best < blocks_least) { return {}; }
    const Block& last = blocks[best_begin + best - 1];
    const std::int64_t origin = recording.segments.front().first_index;
    return {
        static_cast<double>(blocks[best_begin].index - origin) / recording.rate_hz,
        static_cast<double>(last.index + static_cast<std::int64_t>(last.count) - origin) / recording.rate_hz};
}

}  // namespace gyrolog
