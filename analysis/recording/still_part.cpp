#include "analysis/recording/still_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "analysis/recording/still_blocks.hpp"

namespace gyrolog {
namespace {

constexpr double block_s = 1.0;
constexpr std::size_t blocks_least = 4;
constexpr double quiet_factor = 2.0;

}  // namespace

TimeSpan still_part(const Recording& recording, std::span<const std::vector<double>> signals) {
    const std::vector<StillBlock> blocks = still_blocks(recording, signals, block_s);
    if (blocks.size() < blocks_least) { return {}; }
    const std::vector<double> quiet = quiet_sds(blocks, signals.size());
    std::size_t best_begin = 0;
    std::size_t best = 0;
    std::size_t run = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (!is_quiet(blocks[i], quiet, quiet_factor)) {
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
    const StillBlock& last = blocks[best_begin + best - 1];
    const std::int64_t origin = recording.segments.front().first_index;
    return {
        static_cast<double>(blocks[best_begin].index - origin) / recording.rate_hz,
        static_cast<double>(last.index + static_cast<std::int64_t>(last.count) - origin) / recording.rate_hz};
}

}  // namespace gyrolog
