#include "analysis/recording/disturbances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/numerics/distributions.hpp"
#include "analysis/recording/grid_step.hpp"

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

// The means of a block: one before the step and one behind it.
struct TwoMeans {
    std::size_t step = 0;
    double before = 0.0;
    double after = 0.0;

    double off(std::span<const double> values, std::size_t i) const {
        return values[i] - (i < step ? before : after);
    }
};

TwoMeans two_means(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    const double origin = values.front();
    double sum = 0.0;
    for (const double value : values) { sum += value - origin; }
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
    const bool is_one = step == values.size();
    return {step, mean, is_one ? mean : origin + (sum - before) / (n - static_cast<double>(step))};
}

// About two means, less its largest squares. `least`: a power that the numbers' grid has by itself.
Power power_of(std::span<const double> values, double least) {
    const TwoMeans means = two_means(values);
    std::array<double, largest_left_out> largest{};
    double squares = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double off = means.off(values, i);
        squares += off * off;
        keep_largest(largest, off * off);
    }
    const double kept = squares - largest[0] - largest[1];
    return {std::log(std::max(kept / static_cast<double>(values.size()), least)), std::sqrt(largest.back())};
}

// A block less its outliers: single samples that are farther off than this, between such as are not.
std::vector<double> without_outliers(std::span<const double> values, double far_off) {
    const TwoMeans means = two_means(values);
    const auto is_far = [&](std::size_t i) {
        return i < values.size() && std::abs(means.off(values, i)) > far_off;
    };
    std::vector<double> kept;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool is_single = is_far(i) && !is_far(i + 1) && (i == 0 || !is_far(i - 1));
        if (!is_single) { kept.push_back(values[i]); }
    }
    return kept;
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

// A block less the pulse that explains most of it: a level between two edges. Two jumps of one bias are no
// bump.
std::vector<double> without_pulse(std::vector<double> values) {
    const auto n = static_cast<double>(values.size());
    double mean = 0.0;
    for (const double value : values) { mean += value / n; }
    double most = 0.0;
    std::size_t from = 0;
    std::size_t to = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        double inside = 0.0;
        for (std::size_t j = i + 1; j <= values.size() && j - i < values.size(); ++j) {
            inside += values[j - 1] - mean;
            const auto k = static_cast<double>(j - i);
            const double explained = inside * inside * n / (k * (n - k));
            if (explained > most) { most = explained, from = i, to = j; }
        }
    }
    const auto k = static_cast<double>(to - from);
    double inside = 0.0;
    for (std::size_t i = from; i < to; ++i) { inside += values[i] - mean; }
    const double level = k > 0.0 ? inside * n / (k * (n - k)) : 0.0;
    for (std::size_t i = from; i < to; ++i) { values[i] -= level; }
    return values;
}

struct Signal {
    std::vector<Power> powers;   // by block
    std::vector<double> excess;  // of the logarithm of the power over its level, in standard deviations
    std::vector<double> levels;
    std::vector<bool> is_beyond_own;  // by block: the tail of the signal's own blocks
    double sd_log = 0.0;
    double loud_from = 0.0;

    bool is_loud(std::size_t block) const { return excess[block] > loud_from; }
    double ratio(std::size_t block) const { return std::exp(powers[block].log - levels[block]); }
};

// What a grid has by itself (Widrow, Kollar 2008, 1.1): numbers that hardly ever change have no less.
double power_of_grid(std::span<const double> values) {
    const double step = grid_step(values);
    return std::max(step * step / 12.0, std::numeric_limits<double>::min());
}

double sd_of_logs(const Signal& signal, std::size_t samples_per_block) {
    std::vector<double> off;
    for (std::size_t block = 0; block < signal.powers.size(); ++block) {
        off.push_back(std::abs(signal.powers[block].log - signal.levels[block]));
    }
    // A logarithm of a chi-squared variable has this spread at least; coarse codes may have none.
    const double degrees = static_cast<double>(samples_per_block) - fitted_per_block;
    return std::max(sd_per_mad * median_of(std::move(off)), std::sqrt(2.0 / degrees));
}

// Where the tail of these numbers ends: chance has one beyond in a share `chance` of such samples. What lies
// beyond a high threshold is exponential at most, for they are logarithms of a power (Pickands 1975). The
// largest of it may be no noise: its mean is that of a sample censored there (Epstein, Sobel 1953), and no
// less than a normal distribution's.
double end_of_tail(std::vector<double> excess, double chance, const DisturbanceOptions& options) {
    const auto blocks = static_cast<double>(excess.size());
    const double in_tail = std::max(options.tail_blocks_least, std::floor(options.tail_share * blocks));
    const auto tail = static_cast<std::size_t>(in_tail);
    if (2 * tail > excess.size()) { return std::numeric_limits<double>::infinity(); }
    std::ranges::sort(excess);
    const auto seen = static_cast<std::size_t>(std::floor(in_tail * (1.0 - options.tail_censored_share)));
    const std::size_t first = excess.size() - tail;
    const double threshold = excess[first - 1];
    double sum = 0.0;
    for (std::size_t i = 0; i < tail; ++i) { sum += excess[first + std::min(i, seen - 1)] - threshold; }
    const auto r = static_cast<double>(seen);
    const double share = in_tail / blocks;
    const double quantile = normal_upper_quantile(share);
    const double normal_mean =
        std::exp(-0.5 * quantile * quantile) / (share * std::sqrt(2.0 * std::numbers::pi)) - quantile;
    const double mean = std::max(sum / r, normal_mean);
    // The estimated mean is a gamma variable of shape r, and the ratio to it has Lomax' tail.
    return threshold + mean * r * (std::pow(in_tail / chance, 1.0 / r) - 1.0);
}

void find_own_tail(Signal& signal, std::span<const double> values, const std::vector<Block>& blocks,
                   double least, double end) {
    signal.is_beyond_own.assign(blocks.size(), false);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (!(signal.excess[i] > end)) { continue; }
        const std::span<const double> block = values.subspan(blocks[i].first, blocks[i].count);
        const Power less = power_of(without_pulse({block.begin(), block.end()}), least);
        signal.is_beyond_own[i] = (less.log - signal.levels[i]) / signal.sd_log > signal.loud_from;
    }
}

Signal signal_of(std::span<const double> values, const std::vector<Block>& blocks, double quantile,
                 double chance_own, const DisturbanceOptions& options) {
    Signal signal;
    signal.loud_from = quantile;
    const double least = power_of_grid(values);
    for (const Block& block : blocks) {
        signal.powers.push_back(power_of(values.subspan(block.first, block.count), least));
    }
    signal.levels = levels_of(signal.powers, options);
    signal.sd_log = sd_of_logs(signal, blocks.front().count);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const double far_off = options.outlier_sigma * std::exp(0.5 * signal.levels[i]);
        if (signal.powers[i].largest > far_off) {
            const auto rest = without_outliers(values.subspan(blocks[i].first, blocks[i].count), far_off);
            if (rest.size() < blocks[i].count) { signal.powers[i] = power_of(rest, least); }
        }
        signal.excess.push_back((signal.powers[i].log - signal.levels[i]) / signal.sd_log);
    }
    find_own_tail(signal, values, blocks, least, end_of_tail(signal.excess, chance_own, options));
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

bool is_beyond_own(const std::vector<Signal>& signals, std::size_t block) {
    return std::ranges::any_of(signals, [&](const Signal& signal) { return signal.is_beyond_own[block]; });
}

// By block: loud on two signals at once where these are no chance, or beyond the tail of one signal's own
// blocks; or beside such as long as a signal that is loud there stays so, or all together are; and the
// neighbours.
std::vector<bool> disturbed_blocks(const std::vector<Signal>& signals, bool two_are_no_chance) {
    const std::size_t blocks = signals.front().powers.size();
    std::vector<bool> disturbed(blocks, false);
    for (std::size_t block = 0; block < blocks; ++block) {
        const bool at_once = two_are_no_chance && loud_at_once(signals, block) > 1;
        if (!at_once && !is_beyond_own(signals, block)) { continue; }
        const auto goes_on = [&](std::size_t at) {
            return is_loud_in_sum(signals, at) || std::ranges::any_of(signals, [&](const Signal& signal) {
                       return signal.is_loud(block) && signal.is_loud(at);
                   });
        };
        std::size_t from = block;
        std::size_t to = block + 1;
        while (from > 0 && goes_on(from - 1)) { --from; }
        while (to < blocks && goes_on(to)) { ++to; }
        for (std::size_t i = from == 0 ? 0 : from - 1; i < std::min(to + 1, blocks); ++i) {
            disturbed[i] = true;
        }
        block = to - 1;
    }
    return disturbed;
}

// Disturbed blocks as long as they follow without a hole.
std::vector<Disturbance> stretches(const Recording& recording, const std::vector<Block>& blocks,
                                   const std::vector<Signal>& signals, bool two_are_no_chance) {
    const std::vector<bool> disturbed = disturbed_blocks(signals, two_are_no_chance);
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
    const std::vector<Block> blocks = blocks_of(recording, options);
    if (signals.empty() || blocks.size() < options.blocks_least) { return {}; }
    const auto count = static_cast<double>(signals.size());
    // One axis has no other to be loud with at once.
    const double pairs = std::max(0.5 * count * (count - 1.0), 1.0);
    const double chance_each =
        std::sqrt(options.false_alarms_most / (pairs * static_cast<double>(blocks.size())));
    std::vector<Signal> seen;
    for (const std::vector<double>& signal : signals) {
        seen.push_back(signal_of(signal, blocks, normal_upper_quantile(chance_each),
                                 options.false_alarms_most / count, options));
    }
    const bool two_are_no_chance = is_no_chance(seen, chance_each, options.false_alarms_most);
    std::vector<Disturbance> found = stretches(recording, blocks, seen, two_are_no_chance);
    const auto rows = static_cast<double>(recording.rows());
    std::erase_if(found, [&](const Disturbance& one) {
        return static_cast<double>(one.rows) > options.longest_share * rows || one.loud.empty();
    });
    double together = 0.0;
    for (const Disturbance& one : found) { together += static_cast<double>(one.rows); }
    return together > options.together_share * rows ? std::vector<Disturbance>{} : found;
}

}  // namespace gyrolog
