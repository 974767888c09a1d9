#include "analysis/recording/still_runs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "analysis/recording/still_blocks.hpp"

namespace gyrolog {
namespace {

// Where counts hardly ever change, the quietest blocks have no scatter at all: then that of the next louder.
void lift_zeros(std::vector<double>& quiet, const std::vector<StillBlock>& blocks) {
    for (std::size_t s = 0; s < quiet.size(); ++s) {
        if (quiet[s] > 0.0) { continue; }
        double least = std::numeric_limits<double>::infinity();
        for (const StillBlock& block : blocks) {
            if (block.sd[s] > 0.0) { least = std::min(least, block.sd[s]); }
        }
        quiet[s] = std::isfinite(least) ? least : 0.0;
    }
}

bool follows(const StillBlock& before, const StillBlock& block) {
    return before.index + static_cast<std::int64_t>(before.count) == block.index;
}

}  // namespace

std::vector<Segment> still_runs(const Recording& recording, std::span<const std::vector<double>> signals,
                                const StillRunOptions& options) {
    const std::vector<StillBlock> blocks = still_blocks(recording, signals, options.block_s);
    if (blocks.empty()) { return {}; }
    std::vector<double> quiet = quiet_sds(blocks, signals.size());
    lift_zeros(quiet, blocks);
    std::vector<Segment> runs;
    std::size_t run = 0;
    const auto close = [&](std::size_t end) {
        if (run >= options.blocks_least) {
            const StillBlock& first = blocks[end - run + options.edge_blocks];
            const StillBlock& last = blocks[end - 1 - options.edge_blocks];
            runs.push_back({first.first, last.first + last.count - first.first, first.index});
        }
        run = 0;
    };
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const bool quiet_now = is_quiet(blocks[i], quiet, options.quiet_factor);
        const bool joins = run > 0 && quiet_now && follows(blocks[i - 1], blocks[i]) &&
                           goes_on(blocks[i - 1], blocks[i], quiet);
        if (!joins) { close(i); }
        run += quiet_now ? 1 : 0;
    }
    close(blocks.size());
    return runs;
}

}  // namespace gyrolog
