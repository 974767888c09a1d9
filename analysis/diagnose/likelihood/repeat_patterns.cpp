#include "analysis/diagnose/likelihood/repeat_patterns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gyrolog::resolution {

constexpr int rounds_max = 200;
constexpr double settled_nats = 1e-4;
constexpr double first_eps = 0.01;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

bool contains(std::size_t pattern, std::size_t set) { return (pattern & set) == set; }

void mark(const Column& column, const Recording& recording, std::size_t lag, std::size_t bit,
          RowPatterns& patterns) {
    std::visit(
        [&](const auto& data) {
            const ValueRange range(data);
            for (const Segment& segment : recording.segments) {
                for (std::size_t row = segment.first + lag; row < segment.first + segment.count; ++row) {
                    const unsigned repeats =
                        data[row] == data[row - lag] && !range.ends_at(data[row]) ? 1U : 0U;
                    patterns[row] = static_cast<std::uint8_t>(patterns[row] | repeats << bit);
                }
            }
        },
        column.data);
}

// Neighbours often have the same pattern; two tables, in turns, do not wait for each other.
void count_rows(const RowPatterns& patterns, std::size_t from, std::size_t end, PatternCounts& counts) {
    std::array<std::array<std::size_t, repeat_patterns>, 2> tables{};
    for (std::size_t row = from; row < end; ++row) { ++tables[row % 2][patterns[row]]; }
    for (std::size_t pattern = 0; pattern < repeat_patterns; ++pattern) {
        counts[pattern] += static_cast<double>(tables[0][pattern] + tables[1][pattern]);
    }
}

using Chances = std::array<double, repeat_quantities_max>;

// Probability of the quantities outside of `left_out` by chance.
double chance_of(std::size_t pattern, const Chances& chances, std::size_t quantities, std::size_t left_out) {
    double product = 1.0;
    for (std::size_t c = 0; c < quantities; ++c) {
        if ((left_out >> c & 1U) != 0U) { continue; }
        product *= (pattern >> c & 1U) != 0U ? chances[c] : 1.0 - chances[c];
    }
    return product;
}

struct BlockState {
    Chances chances{};
    double log_likelihood_nats = 0.0;
    double stale = 0.0;  // expected number
};

BlockState begin(const PatternCounts& counts, std::size_t quantities) {
    BlockState state;
    const double all = count_all(counts);
    for (std::size_t c = 0; c < quantities; ++c) {
        state.chances[c] = all > 0.0 ? count_containing(counts, std::size_t{1} << c) / all : 0.0;
    }
    return state;
}

// Expectation with the given chances, then their maximisation.
void improve(const PatternCounts& counts, std::size_t quantities, std::size_t set, double eps,
             BlockState& state) {
    PatternCounts fresh{};
    state.log_likelihood_nats = 0.0;
    state.stale = 0.0;
    for (std::size_t pattern = 0; pattern < (std::size_t{1} << quantities); ++pattern) {
        if (counts[pattern] == 0.0) { continue; }
        const double by_chance = (1.0 - eps) * chance_of(pattern, state.chances, quantities, 0);
        const double stale =
            contains(pattern, set) ? eps * chance_of(pattern, state.chances, quantities, set) : 0.0;
        const double share = stale / std::max(stale + by_chance, 1e-300);
        state.log_likelihood_nats += counts[pattern] * std::log(std::max(stale + by_chance, 1e-300));
        state.stale += share * counts[pattern];
        fresh[pattern] = (1.0 - share) * counts[pattern];
    }
    for (std::size_t c = 0; c < quantities; ++c) {
        const bool in_set = (set >> c & 1U) != 0U;
        const PatternCounts& shown = in_set ? fresh : counts;
        const double all = count_all(shown);
        if (all > 0.0) { state.chances[c] = count_containing(shown, std::size_t{1} << c) / all; }
    }
}

RepeatFit fit(const std::vector<PatternCounts>& blocks, std::size_t quantities, std::size_t set, double eps,
              bool eps_is_free) {
    std::vector<BlockState> states;
    double all = 0.0;
    for (const PatternCounts& counts : blocks) {
        states.push_back(begin(counts, quantities));
        all += count_all(counts);
    }
    RepeatFit best{eps, 0.0};
    for (int round = 0; round < resolution::rounds_max; ++round) {
        double nats = 0.0;
        double stale = 0.0;
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            improve(blocks[b], quantities, set, best.eps, states[b]);
            nats += states[b].log_likelihood_nats;
            stale += states[b].stale;
        }
        const bool settled = round > 0 && nats - best.log_likelihood_nats < resolution::settled_nats;
        best.log_likelihood_nats = nats;
        if (settled) { break; }
        if (eps_is_free && all > 0.0) { best.eps = stale / all; }
    }
    return best;
}

}  // namespace

RowPatterns row_patterns(const Recording& recording, const std::vector<const Column*>& quantities,
                         std::size_t lag) {
    RowPatterns patterns(recording.rows(), 0);
    for (std::size_t c = 0; c < quantities.size(); ++c) { mark(*quantities[c], recording, lag, c, patterns); }
    return patterns;
}

RowPatterns patterns_of_some(const RowPatterns& patterns, std::span<const std::size_t> quantities) {
    std::array<std::uint8_t, repeat_patterns> of_some{};
    for (std::size_t pattern = 0; pattern < repeat_patterns; ++pattern) {
        std::size_t seen = 0;
        for (std::size_t c = 0; c < quantities.size(); ++c) { seen |= (pattern >> quantities[c] & 1U) << c; }
        of_some[pattern] = static_cast<std::uint8_t>(seen);
    }
    RowPatterns some(patterns.size());
    std::ranges::transform(patterns, some.begin(), [&](std::uint8_t pattern) { return of_some[pattern]; });
    return some;
}

void leave_out_runs(const RowPatterns& next, std::size_t quantities, RowPatterns& apart) {
    const auto all = static_cast<std::uint8_t>((std::size_t{1} << quantities) - 1);
    for (std::size_t row = 1; row < apart.size(); ++row) {
        if (next[row] == all && next[row - 1] == all) { apart[row] = 0; }
    }
}

std::vector<PatternCounts> count_patterns(const Recording& recording, const RowPatterns& patterns,
                                          std::size_t lag, std::size_t blocks) {
    std::vector<PatternCounts> counts(blocks);
    const auto block_of = [&](std::size_t row) { return row * blocks / patterns.size(); };
    for (const Segment& segment : recording.segments) {
        const std::size_t end = segment.first + segment.count;
        for (std::size_t row = segment.first + lag; row < end;) {
            const std::size_t block = block_of(row);
            // The first row of the next block.
            const std::size_t next = ((block + 1) * patterns.size() + blocks - 1) / blocks;
            count_rows(patterns, row, std::min(end, next), counts[block]);
            row = next;
        }
    }
    return counts;
}

double count_containing(const PatternCounts& counts, std::size_t set) {
    double count = 0.0;
    for (std::size_t pattern = 0; pattern < counts.size(); ++pattern) {
        if (contains(pattern, set)) { count += counts[pattern]; }
    }
    return count;
}

double count_all(const PatternCounts& counts) { return count_containing(counts, 0); }

RepeatFit fit_chance(const std::vector<PatternCounts>& blocks, std::size_t quantities, std::size_t set,
                     double eps) {
    return fit(blocks, quantities, set, eps, false);
}

RepeatFit fit_repeats(const std::vector<PatternCounts>& blocks, std::size_t quantities, std::size_t set) {
    return fit(blocks, quantities, set, resolution::first_eps, true);
}

}  // namespace gyrolog
