#include "analysis/recording/still_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {
namespace {

constexpr std::size_t block_samples_least = 16;
constexpr std::size_t blocks_wanted = 20;
constexpr double step_factor = 6.0;
constexpr double drift_share = 0.5;  // of the quiet standard deviation, from one block to the next

StillBlock block_of(std::span<const std::vector<double>> signals, std::size_t first, std::size_t count,
                    std::int64_t index) {
    StillBlock block{first, count, index, {}, {}};
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

}  // namespace

std::vector<StillBlock> still_blocks(const Recording& recording, std::span<const std::vector<double>> signals,
                                     double block_s) {
    std::size_t size = std::max(block_samples_least, static_cast<std::size_t>(block_s * recording.rate_hz));
    size = std::max(block_samples_least, std::min(size, recording.rows() / blocks_wanted));
    std::vector<StillBlock> blocks;
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i + size <= segment.count; i += size) {
            blocks.push_back(block_of(signals, segment.first + i, size,
                                      segment.first_index + static_cast<std::int64_t>(i)));
        }
    }
    return blocks;
}

std::vector<double> quiet_sds(const std::vector<StillBlock>& blocks, std::size_t signals) {
    std::vector<double> quiet(signals);
    if (blocks.empty()) { return quiet; }
    std::vector<double> sds(blocks.size());
    for (std::size_t s = 0; s < signals; ++s) {
        std::ranges::transform(blocks, sds.begin(), [&](const StillBlock& block) { return block.sd[s]; });
        const auto decile = sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 10);
        std::nth_element(sds.begin(), decile, sds.end());
        quiet[s] = *decile;
    }
    return quiet;
}

bool is_quiet(const StillBlock& block, const std::vector<double>& quiet, double factor) {
    for (std::size_t s = 0; s < quiet.size(); ++s) {
        if (block.sd[s] > factor * quiet[s]) { return false; }
    }
    return true;
}

bool goes_on(const StillBlock& before, const StillBlock& block, const std::vector<double>& quiet) {
    for (std::size_t s = 0; s < quiet.size(); ++s) {
        const double error =
            quiet[s] * (std::sqrt(2.0 / static_cast<double>(block.count)) + drift_share / step_factor);
        if (std::abs(block.mean[s] - before.mean[s]) > step_factor * error) { return false; }
    }
    return true;
}

}  // namespace gyrolog
