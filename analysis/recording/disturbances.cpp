#include "analysis/recording/disturbances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/numerics/distributions.hpp"

namespace gyrolog {
namespace {

constexpr double sd_per_mad = 1.4826;     // of a normal distribution
constexpr double fitted_per_block = 3.0;  // two means and where the step is
constexpr std::size_t largest_left_out = 2;

struct Block {
    std::size_t first = 0;
    std::size_t count = 0;
    std::int64_t index = 0;  // on the grid
};

struct Power {
    double log = 0.0;
    double largest = 0.0;
};

std::vector<Block> blocks_of(const Recording& recording, const DisturbanceOptions& options) {
    const auto wanted = static_cast<std::size_t>(std::llround(options.block_s * recording.rate_hz));
    const std::size_t count = std::max(options.block_samples_least, wanted);
    std::vector<Block> blocks;
    for (const Segment& segment : recording.segments) {
        for (std::size_t at = 0; at + count <= segment.count; at += count) {
            blocks.push_back(
                {segment.first + at, count, segment.first_index + static_cast<std::int64_t>(at)});
        }
    }
    return blocks;
}

// The largest squares about the two means, the least of them first.
void keep_largest(std::array<double, largest_left_out>& largest, double square) {
    if (square <= largest.front()) { return; }
    largest.front() = square;
    std::ranges::sort(largest);
}

Power power_of(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    const double origin = values.front();
    double sum = 0.0;
    double squares = 0.0;
    for (const double value : values) {
        sum += value - origin;
        squares += (value - origin) * (value - origin);
    }
    std::size_t step = values.size();
    double before = sum;
    double explained = sum * sum / n;
    double running = 0.0;
    for (std::size_t i = 1; i < values.size(); ++i) {
        running += values[i - 1] - origin;
        const auto k = static_cast<double>(i);
        const double rest = sum - running;
        const double here = running * running / k + rest * rest / (n - k);
        if (here > explained) { explained = here, step = i, before = running; }
    }
    const double mean = origin + before / static_cast<double>(step);
    const double after =
        step < values.size() ? origin + (sum - before) / (n - static_cast<double>(step)) : mean;
    std::array<double, largest_left_out> largest{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double off = values[i] - (i < step ? mean : after);
        keep_largest(largest, off * off);
    }
    const double kept = squares - explained - largest[0] - largest[1];
    return {std::log(std::max(kept / n, std::numeric_limits<double>::min())), std::sqrt(largest.back())};
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

// The level of the blocks around each. The noise may change slowly, with the temperature, say; of a window of
// four times the longest disturbance one is a quarter, which a median hardly feels. Between the middles of
// two windows the larger level holds, so that the blocks beside a step of the noise are none. At the ends of
// the recording the window is as wide, for a recording often begins with a touch.
std::vector<double> levels_of(const std::vector<Power>& powers, const DisturbanceOptions& options) {
    const std::size_t blocks = powers.size();
    const auto longest = static_cast<std::size_t>(options.longest_share * static_cast<double>(blocks));
    const std::size_t half = std::max(2 * longest, options.blocks_least / 2);
    std::vector<double> of_windows;
    for (std::size_t middle = 0; middle < blocks + half; middle += half) {
        std::vector<double> logs;
        const std::size_t width = std::min(2 * half, blocks);
        const std::size_t first = std::min(middle - std::min(middle, half), blocks - width);
        for (std::size_t i = first; i < first + width; ++i) { logs.push_back(powers[i].log); }
        of_windows.push_back(median_of(std::move(logs)));
    }
    std::vector<double> levels(blocks);
    for (std::size_t block = 0; block < blocks; ++block) {
        const std::size_t window = block / half;
        levels[block] = std::max(of_windows[window], of_windows[window + 1]);
    }
    return levels;
}

struct Signal {
    std::vector<Power> powers;   // by block
    std::vector<double> excess;  // of the logarithm of the power over its level, in standard deviations
    std::vector<double> levels;
    double loud_from = 0.0;

    bool is_loud(std::size_t block) const { return excess[block] > loud_from; }
    double ratio(std::size_t block) const { return std::exp(powers[block].log - levels[block]); }
};

Signal signal_of(std::span<const double> values, const std::vector<Block>& blocks, double quantile,
                 const DisturbanceOptions& options) {
    Signal signal;
    signal.loud_from = quantile;
    for (const Block& block : blocks) {
        signal.powers.push_back(power_of(values.subspan(block.first, block.count)));
    }
    signal.levels = levels_of(signal.powers, options);
    std::vector<double> off;
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        off.push_back(std::abs(signal.powers[block].log - signal.levels[block]));
    }
    // A logarithm of a chi-squared variable has this spread at least; coarse codes may have none.
    const double degrees = static_cast<double>(blocks.front().count) - fitted_per_block;
    const double sd = std::max(sd_per_mad * median_of(std::move(off)), std::sqrt(2.0 / degrees));
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        signal.excess.push_back((signal.powers[block].log - signal.levels[block]) / sd);
    }
    return signal;
}

// P(X >= count) of a Poisson variable.
double poisson_tail(std::size_t count, double mean) {
    if (count == 0) { return 1.0; }
    return 1.0 - gamma_upper_tail(static_cast<double>(count), mean);
}

std::size_t loud_at_once(const std::vector<Signal>& signals, std::size_t block) {
    return static_cast<std::size_t>(
        std::ranges::count_if(signals, [&](const Signal& signal) { return signal.is_loud(block); }));
}

// Whether all signals together are as loud as one has to be: a disturbance that rings out is still there.
bool is_loud_in_sum(const std::vector<Signal>& signals, std::size_t block) {
    double sum = 0.0;
    for (const Signal& signal : signals) { sum += signal.excess[block]; }
    return sum > signals.front().loud_from * std::sqrt(static_cast<double>(signals.size()));
}

// Whether blocks that are loud on two signals at once are more than chance has.
bool is_no_chance(const std::vector<Signal>& signals, double chance_each, double false_alarms_most) {
    const std::size_t blocks = signals.front().powers.size();
    std::size_t together = 0;
    std::vector<double> alone(signals.size(), 0.0);
    for (std::size_t block = 0; block < blocks; ++block) {
        const std::size_t count = loud_at_once(signals, block);
        if (count > 1) { ++together; }
        if (count != 1) { continue; }
        for (std::size_t s = 0; s < signals.size(); ++s) {
            alone[s] += signals[s].is_loud(block) ? 1.0 : 0.0;
        }
    }
    const auto n = static_cast<double>(blocks);
    double expected = 0.0;
    for (std::size_t a = 0; a < signals.size(); ++a) {
        for (std::size_t b = a + 1; b < signals.size(); ++b) {
            expected += n * (chance_each + alone[a] / n) * (chance_each + alone[b] / n);
        }
    }
    return together > 0 && poisson_tail(together, expected) < false_alarms_most;
}

// Of a variance of its own: the likelihood ratio of a block of normal samples.
double gain_nats(const Signal& signal, std::size_t block, std::size_t count) {
    const double ratio = signal.ratio(block);
    const double degrees = static_cast<double>(count) - fitted_per_block;
    return ratio > 1.0 ? 0.5 * degrees * (ratio - 1.0 - std::log(ratio)) : 0.0;
}

void add_block(Disturbance& disturbance, const std::vector<Signal>& signals, std::size_t block,
               std::size_t count) {
    for (std::size_t s = 0; s < signals.size(); ++s) {
        disturbance.gain_nats[s] += gain_nats(signals[s], block, count);
        disturbance.largest = std::max(disturbance.largest, signals[s].powers[block].largest);
        if (signals[s].is_loud(block) && std::ranges::count(disturbance.loud, s) == 0) {
            disturbance.loud.push_back(s);
        }
    }
}

// By block: loud on two signals at once, or beside such as long as all together are loud; and the neighbours.
std::vector<bool> disturbed_blocks(const std::vector<Signal>& signals) {
    const std::size_t blocks = signals.front().powers.size();
    std::vector<bool> disturbed(blocks, false);
    for (std::size_t block = 0; block < blocks; ++block) {
        if (loud_at_once(signals, block) < 2) { continue; }
        std::size_t from = block;
        std::size_t to = block + 1;
        while (from > 0 && is_loud_in_sum(signals, from - 1)) { --from; }
        while (to < blocks && is_loud_in_sum(signals, to)) { ++to; }
        for (std::size_t i = from == 0 ? 0 : from - 1; i < std::min(to + 1, blocks); ++i) {
            disturbed[i] = true;
        }
        block = to - 1;
    }
    return disturbed;
}

// Disturbed blocks as long as they follow without a hole.
std::vector<Disturbance> stretches(const Recording& recording, const std::vector<Block>& blocks,
                                   const std::vector<Signal>& signals) {
    const std::vector<bool> disturbed = disturbed_blocks(signals);
    std::vector<Disturbance> found;
    const std::int64_t origin = recording.segments.front().first_index;
    const auto seconds = [&](std::int64_t index) {
        return static_cast<double>(index - origin) / recording.rate_hz;
    };
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        if (!disturbed[block]) { continue; }
        const Block& here = blocks[block];
        const bool goes_on = block > 0 && disturbed[block - 1] && !found.empty() &&
                             found.back().first + found.back().rows == here.first;
        if (!goes_on) {
            found.push_back(
                {here.first, 0, seconds(here.index), 0.0, {}, std::vector<double>(signals.size(), 0.0), 0.0});
        }
        found.back().rows += here.count;
        found.back().to_s = seconds(here.index + static_cast<std::int64_t>(here.count));
        add_block(found.back(), signals, block, here.count);
    }
    return found;
}

}  // namespace

std::vector<Disturbance> disturbances(const Recording& recording,
                                      std::span<const std::vector<double>> signals,
                                      const DisturbanceOptions& options) {
    if (signals.size() < 2) { return {}; }
    const std::vector<Block> blocks = blocks_of(recording, options);
    if (blocks.size() < options.blocks_least) { return {}; }
    const auto pairs = 0.5 * static_cast<double>(signals.size() * (signals.size() - 1));
    const double chance_each =
        std::sqrt(options.false_alarms_most / (pairs * static_cast<double>(blocks.size())));
    std::vector<Signal> seen;
    for (const std::vector<double>& signal : signals) {
        seen.push_back(signal_of(signal, blocks, normal_upper_quantile(chance_each), options));
    }
    if (!is_no_chance(seen, chance_each, options.false_alarms_most)) { return {}; }
    std::vector<Disturbance> found = stretches(recording, blocks, seen);
    const auto rows = static_cast<double>(recording.rows());
    std::erase_if(found, [&](const Disturbance& one) {
        return static_cast<double>(one.rows) > options.longest_share * rows || one.loud.size() < 2;
    });
    double together = 0.0;
    for (const Disturbance& one : found) { together += static_cast<double>(one.rows); }
    return together > options.together_share * rows ? std::vector<Disturbance>{} : found;
}

}  // namespace gyrolog
