#include "analysis/recording/disturbances.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "analysis/numerics/distributions.hpp"
#include "analysis/numerics/exponential_tail.hpp"
#include "analysis/numerics/normal_scores.hpp"
#include "analysis/recording/grid_step.hpp"
#include "analysis/recording/ringing.hpp"

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

// `times` as long as the shortest.
std::vector<Block> blocks_of(const Recording& recording, std::size_t times,
                             const DisturbanceOptions& options) {
    const auto wanted = static_cast<std::size_t>(std::llround(options.block_s * recording.rate_hz));
    const std::size_t count = times * std::max(options.block_samples_least, wanted);
    std::vector<Block> blocks;
    for (const Segment& segment : recording.segments) {
        for (std::size_t at = 0; at + count <= segment.count; at += count) {
            blocks.push_back(
                {segment.first + at, count, segment.first_index + static_cast<std::int64_t>(at)});
        }
    }
    return blocks;
}

// Of the recording, that one disturbance may last.
double longest_share_of(const Recording& recording, const DisturbanceOptions& options) {
    const double duration_s = static_cast<double>(recording.rows()) / recording.rate_hz;
    return std::max(options.longest_share, std::min(options.longest_s / duration_s, options.together_share));
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

// Of blocks of one length.
class StepSearch {
public:
    explicit StepSearch(std::size_t count) : weights_(count) {
        const auto n = static_cast<double>(count);
        for (std::size_t i = 1; i < count; ++i) {
            const auto k = static_cast<double>(i);
            weights_[i] = n / (k * (n - k));
        }
    }

    // With k of n numbers before it, whose sum is off by d from k means, a step explains d^2 n / (k (n - k))
    // of the squares about the mean.
    TwoMeans two_means(std::span<const double> values) const {
        const auto n = static_cast<double>(values.size());
        const double origin = values.front();
        double sum = 0.0;
        for (const double value : values) { sum += value - origin; }
        const double mean = sum / n;
        std::size_t step = values.size();
        double before = sum;
        double explained = 0.0;
        double running = 0.0;
        for (std::size_t i = 1; i < values.size(); ++i) {
            running += values[i - 1] - origin;
            const double off = running - static_cast<double>(i) * mean;
            const double here = off * off * weights_[i];
            if (here > explained) { explained = here, step = i, before = running; }
        }
        const double of_first = origin + before / static_cast<double>(step);
        const bool is_one = step == values.size();
        return {step, of_first,
                is_one ? of_first : origin + (sum - before) / (n - static_cast<double>(step))};
    }

private:
    std::vector<double> weights_;
};

// Less the largest squares. `least`: a power that the numbers' grid has by itself.
Power power_of_rest(std::span<const double> rest, double least) {
    std::array<double, largest_left_out> largest{};
    double squares = 0.0;
    for (const double off : rest) {
        squares += off * off;
        keep_largest(largest, off * off);
    }
    const double kept = squares - largest[0] - largest[1];
    return {std::log(std::max(kept / static_cast<double>(rest.size()), least)), std::sqrt(largest.back())};
}

// About two means.
Power power_of(std::span<const double> values, const StepSearch& search, double least) {
    const TwoMeans means = search.two_means(values);
    std::vector<double> rest(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) { rest[i] = means.off(values, i); }
    return power_of_rest(rest, least);
}

// Changes the order of the values.
double median_in_place(std::span<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

double median_of(std::vector<double> values) { return median_in_place(values); }

// The level of the blocks around each. The noise may change slowly, with the temperature, say; of a window of
// four times the longest disturbance one is a quarter, which a median hardly feels. Between the middles of
// two windows the larger level holds, so that the blocks beside a step of the noise are none. At the ends of
// the recording the window is as wide, for a recording often begins with a touch.
std::vector<double> levels_of(const std::vector<Power>& powers, double longest_share,
                              const DisturbanceOptions& options) {
    const std::size_t blocks = powers.size();
    const auto longest = static_cast<std::size_t>(longest_share * static_cast<double>(blocks));
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

// Twice the log-likelihood ratio of normal numbers with so many degrees of freedom whose power is `ratio`
// times what it is elsewhere.
double twice_gain_nats(double ratio, double degrees) {
    return std::max(degrees * (ratio - 1.0 - std::log(ratio)), 0.0);
}

// The powers of blocks, and what they are around each.
struct Course {
    std::vector<Power> powers;
    std::vector<double> levels;
    double least_power = 0.0;

    // Of a power in the place of the block's.
    double over_level(const Power& power, std::size_t block) const { return power.log - levels[block]; }
    double over_level(std::size_t block) const { return over_level(powers[block], block); }
};

// One signal, and the step of its grid.
struct Numbers {
    std::span<const double> values;
    double step = 0.0;
};

struct Signal {
    std::vector<double> scores;  // of the numbers, normal
    Course loudness;             // of these
    double degrees = 0.0;        // of freedom of a block of them
    double loud_from = 0.0;
    // Of the loudness over its level, by block: the signed root of twice the gain, nearly a normal variable.
    std::vector<double> excess;

    double root(double over_level) const {
        return std::copysign(std::sqrt(twice_gain_nats(std::exp(over_level), degrees)), over_level);
    }
    bool is_loud(std::size_t block) const { return excess[block] > loud_from; }
};

// The grid's step. grid_step() wants four codes: of two or three it is the widest gap between them. 0: no
// grid.
double code_step(std::span<const double> values) {
    const double step = grid_step(values);
    constexpr std::size_t codes_most = 3;
    std::set<double> codes;
    for (std::size_t i = 0; step == 0.0 && i < values.size() && codes.size() <= codes_most; ++i) {
        codes.insert(values[i]);
    }
    if (codes.size() < 2 || codes.size() > codes_most) { return step; }
    double widest = 0.0;
    for (auto code = codes.begin(), next = std::next(code); next != codes.end(); ++code, ++next) {
        widest = std::max(widest, *next - *code);
    }
    return widest;
}

// Numbers on two neighbouring codes have no more power (Popoviciu 1935): how often they change from one to
// the other is no loudness.
double power_of_codes(double step) { return std::max(step * step / 4.0, std::numeric_limits<double>::min()); }

// A logarithm of a chi-squared variable has the variance 2 / degrees. Numbers that depend on their neighbours
// have fewer degrees than there are numbers; coarse codes may have no spread.
double degrees_of(const Course& loudness, std::size_t samples_per_block) {
    std::vector<double> off;
    for (std::size_t block = 0; block < loudness.powers.size(); ++block) {
        off.push_back(std::abs(loudness.over_level(block)));
    }
    const double sd = sd_per_mad * median_of(std::move(off));
    const double most = static_cast<double>(samples_per_block) - fitted_per_block;
    return 2.0 / std::max(sd * sd, 2.0 / most);
}

// Puts the signed normal score about its block's median in the place of each number: a number that is far off
// weighs as much as the one of the same rank in normal noise. Returns the score of `step`, the step of the
// numbers' grid.
double take_scores(std::span<const double> values, const std::vector<Block>& blocks, double step,
                   const DisturbanceOptions& options, std::vector<double>& scores) {
    scores.assign(values.size(), 0.0);
    std::vector<double> magnitudes;
    std::vector<double> sorted(blocks.front().count);
    const std::size_t every = 1 + blocks.size() * blocks.front().count / options.magnitudes_most;
    for (const Block& block : blocks) {
        const auto here = values.subspan(block.first, block.count);
        std::ranges::copy(here, sorted.begin());
        const double median = median_in_place(sorted);
        for (std::size_t i = 0; i < here.size(); ++i) {
            scores[block.first + i] = here[i] - median;
            if ((block.first + i) % every == 0) { magnitudes.push_back(std::abs(here[i] - median)); }
        }
    }
    const NormalScores of_magnitudes(std::move(magnitudes));
    for (double& score : scores) {
        if (score != 0.0) { score = std::copysign(of_magnitudes.of(std::abs(score)), score); }
    }
    return step > 0.0 ? of_magnitudes.of(step) : 0.0;
}

Course course_of(std::span<const double> values, const std::vector<Block>& blocks, double least_power,
                 double longest_share, const DisturbanceOptions& options) {
    Course course;
    course.least_power = least_power;
    const StepSearch search(blocks.front().count);
    for (const Block& block : blocks) {
        course.powers.push_back(power_of(values.subspan(block.first, block.count), search, least_power));
    }
    course.levels = levels_of(course.powers, longest_share, options);
    return course;
}

Signal signal_of(const Numbers& numbers, const std::vector<Block>& blocks, double longest_share,
                 const DisturbanceOptions& options) {
    Signal signal;
    signal.loud_from = normal_upper_quantile(1.0 / static_cast<double>(blocks.size()));
    const double step_score = take_scores(numbers.values, blocks, numbers.step, options, signal.scores);
    signal.loudness = course_of(signal.scores, blocks, power_of_codes(step_score), longest_share, options);
    signal.degrees = degrees_of(signal.loudness, blocks.front().count);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        signal.excess.push_back(signal.root(signal.loudness.over_level(i)));
    }
    return signal;
}

// Two jumps of one bias in a block are no bump. Two half periods of a bump are hardly more than a pulse and a
// step, which have as many parameters as an oscillation that dies out: what leaves less of the block is it.
bool is_pulse(const Signal& signal, const Block& at, std::size_t block) {
    const auto scores = std::span(signal.scores).subspan(at.first, at.count);
    const double least = signal.loudness.least_power;
    const Power rest = power_of(without_pulse({scores.begin(), scores.end()}), StepSearch(at.count), least);
    if (signal.root(signal.loudness.over_level(rest, block)) > signal.loud_from) { return false; }
    return rest.log <= power_of_rest(without_ringing(scores), least).log;
}

// -ln (P(X >= least) / p^least) of a binomial variable X. The power of p, which may be too small for a
// double, is left to the caller.
double binomial_tail_nats(double p, std::size_t count, std::size_t least) {
    // By Horner's rule in p, from X = count down.
    double ways = 1.0;        // to choose so many of all
    double others = 1.0;      // (1 - p)^(count - X)
    double over_power = 0.0;  // of p^least
    for (std::size_t chosen = count; chosen >= least; --chosen) {
        over_power = over_power * p + ways * others;
        ways *= static_cast<double>(chosen) / static_cast<double>(count - chosen + 1);
        others *= 1.0 - p;
    }
    return -std::log(over_power);
}

// That two of these, or more, are as large as they are, if they are independent: a sensor's own noise is loud
// on one axis at a time. Puts them in order.
double surprisal_of_several(std::span<double> nats) {
    std::ranges::sort(nats, std::greater{});
    double most = 0.0;
    for (std::size_t several = 2; several <= nats.size(); ++several) {
        const double each = nats[several - 1];
        most = std::max(most, static_cast<double>(several) * each +
                                  binomial_tail_nats(std::exp(-each), nats.size(), several));
    }
    return most;
}

// Whether all signals together are as loud as one has to be: a disturbance that rings out is still there.
bool is_loud_in_sum(const std::vector<Signal>& signals, std::size_t block) {
    double sum = 0.0;
    for (const Signal& signal : signals) { sum += signal.excess[block]; }
    return sum > signals.front().loud_from * std::sqrt(static_cast<double>(signals.size()));
}

// Of a variance of its own: the likelihood ratio of a block of normal samples.
double gain_nats(const Course& course, std::size_t block, std::size_t count) {
    const double ratio = std::exp(course.over_level(block));
    const double degrees = static_cast<double>(count) - fitted_per_block;
    return ratio > 1.0 ? 0.5 * twice_gain_nats(ratio, degrees) : 0.0;
}

void add_block(Disturbance& disturbance, const std::vector<Signal>& signals,
               const std::vector<Course>& courses, std::size_t block, std::size_t count) {
    for (std::size_t s = 0; s < signals.size(); ++s) {
        disturbance.gain_nats[s] += gain_nats(courses[s], block, count);
        disturbance.largest = std::max(disturbance.largest, courses[s].powers[block].largest);
        if (signals[s].is_loud(block) && std::ranges::count(disturbance.loud, s) == 0) {
            disturbance.loud.push_back(s);
        }
    }
}

// Of some signals in the blocks that are not disturbed, what is: in a row of passes, each with what is left.
class DisturbedBlocks {
public:
    DisturbedBlocks(const std::vector<Signal>& signals, const std::vector<Block>& blocks)
        : signals_(signals), blocks_(blocks), is_disturbed_(blocks.size(), false) {}

    // Blocks in which several signals are loud at once, as by chance they are not.
    void take_loud_at_once(const ExponentialTailOptions& options, double chance) {
        const std::vector<std::size_t> left = undisturbed();
        std::vector<std::vector<double>> nats;
        for (const Signal& signal : signals_) {
            const std::vector<double> gains = gains_of(signal, left);
            const auto tail = ExponentialTail::of(gains, options);
            if (!tail) { return; }
            nats.push_back(tail->surprisals_nats(gains));
        }
        std::vector<double> at_once(left.size());
        std::vector<double> each(nats.size());
        for (std::size_t i = 0; i < left.size(); ++i) {
            std::ranges::transform(nats, each.begin(),
                                   [&](const std::vector<double>& of_signal) { return of_signal[i]; });
            at_once[i] = surprisal_of_several(each);
        }
        const auto tail = ExponentialTail::of(at_once, options);
        const double end = tail->end(at_once, chance, beyond_);
        for (std::size_t i = 0; i < left.size(); ++i) {
            if (at_once[i] > end) { take(left[i]); }
        }
    }

    // Blocks in which one signal is louder than it is otherwise.
    void take_loud_alone(const ExponentialTailOptions& options, double chance) {
        const std::vector<std::size_t> left = undisturbed();
        for (const Signal& signal : signals_) {
            const std::vector<double> gains = gains_of(signal, left);
            const auto tail = ExponentialTail::of(gains, options);
            if (!tail) { return; }
            const double end = tail->end(gains, chance, beyond_);
            for (std::size_t i = 0; i < left.size(); ++i) {
                if (gains[i] > end && !is_pulse(signal, blocks_[left[i]], left[i])) { take(left[i]); }
            }
        }
    }

    const std::vector<bool>& are() const { return is_disturbed_; }

private:
    std::vector<std::size_t> undisturbed() const {
        std::vector<std::size_t> left;
        for (std::size_t block = 0; block < is_disturbed_.size(); ++block) {
            if (!is_disturbed_[block]) { left.push_back(block); }
        }
        return left;
    }

    // In nats, signed as the excess: half the square of a nearly normal variable.
    static std::vector<double> gains_of(const Signal& signal, const std::vector<std::size_t>& blocks) {
        std::vector<double> gains(blocks.size());
        std::ranges::transform(blocks, gains.begin(), [&](std::size_t block) {
            return 0.5 * signal.excess[block] * std::abs(signal.excess[block]);
        });
        return gains;
    }

    // With those beside it as long as a signal that is loud there stays so, or all together are.
    void take(std::size_t block) {
        const auto goes_on = [&](std::size_t at) {
            return is_loud_in_sum(signals_, at) || std::ranges::any_of(signals_, [&](const Signal& signal) {
                       return signal.is_loud(block) && signal.is_loud(at);
                   });
        };
        ++beyond_;
        const std::size_t blocks = is_disturbed_.size();
        std::size_t from = block;
        std::size_t to = block + 1;
        while (from > 0 && goes_on(from - 1)) { --from; }
        while (to < blocks && goes_on(to)) { ++to; }
        for (std::size_t i = from; i < to; ++i) { is_disturbed_[i] = true; }
    }

    const std::vector<Signal>& signals_;
    const std::vector<Block>& blocks_;
    std::vector<bool> is_disturbed_;
    std::size_t beyond_ = 0;  // of these, that are so without those beside
};

// First as many blocks are censored as may be disturbed; a sharper tail is that of what is left then.
std::vector<bool> disturbed_blocks(const std::vector<Signal>& signals, const std::vector<Block>& blocks,
                                   const DisturbanceOptions& options) {
    DisturbedBlocks disturbed(signals, blocks);
    const auto tails = static_cast<double>((signals.size() + 2) * options.block_lengths.size());
    const double chance = options.false_alarms_most / tails;
    // What half a normal variable's square has beyond a threshold has a mean of 1 nat in the limit.
    const ExponentialTailOptions of_the_rest{.mean_least = 1.0};
    if (signals.size() > 1) {
        ExponentialTailOptions of_all = of_the_rest;
        of_all.share = 2.0 * options.together_share;
        of_all.censored_share = 0.5;
        disturbed.take_loud_at_once(of_all, chance);
        disturbed.take_loud_at_once(of_the_rest, chance);
    }
    disturbed.take_loud_alone(of_the_rest, chance);
    return disturbed.are();
}

struct Seen {
    std::vector<Block> blocks;
    std::vector<Signal> signals;
    std::vector<bool> disturbed;  // by block
};

// Nothing where there are no signals, or too few blocks.
Seen seen_in_blocks(const Recording& recording, const std::vector<Numbers>& signals, std::size_t times,
                    double longest_share, const DisturbanceOptions& options) {
    Seen seen{blocks_of(recording, times, options), {}, {}};
    if (signals.empty() || seen.blocks.size() < options.blocks_least) { return {}; }
    for (const Numbers& signal : signals) {
        seen.signals.push_back(signal_of(signal, seen.blocks, longest_share, options));
    }
    seen.disturbed = disturbed_blocks(seen.signals, seen.blocks, options);
    return seen;
}

// With one more on either side.
std::vector<bool> and_neighbours(const std::vector<bool>& disturbed) {
    std::vector<bool> wider = disturbed;
    for (std::size_t block = 0; block < disturbed.size(); ++block) {
        if (!disturbed[block]) { continue; }
        if (block > 0) { wider[block - 1] = true; }
        if (block + 1 < disturbed.size()) { wider[block + 1] = true; }
    }
    return wider;
}

// Marks the blocks that begin in disturbed ones of the longer ones.
void take_over(const Seen& longer, Seen& shorter) {
    std::size_t at = 0;
    for (std::size_t block = 0; block < longer.blocks.size(); ++block) {
        if (!longer.disturbed[block]) { continue; }
        const Block& here = longer.blocks[block];
        while (at < shorter.blocks.size() && shorter.blocks[at].first < here.first) { ++at; }
        for (; at < shorter.blocks.size() && shorter.blocks[at].first < here.first + here.count; ++at) {
            shorter.disturbed[at] = true;
        }
    }
}

// Disturbed blocks as long as they follow without a hole.
std::vector<Disturbance> stretches(const Recording& recording, const Seen& seen,
                                   const std::vector<Course>& courses, const std::vector<bool>& disturbed) {
    const std::vector<Block>& blocks = seen.blocks;
    const std::vector<Signal>& signals = seen.signals;
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
        add_block(found.back(), signals, courses, block, here.count);
    }
    return found;
}

}  // namespace

std::vector<Disturbance> disturbances(const Recording& recording,
                                      std::span<const std::vector<double>> signals,
                                      const DisturbanceOptions& options) {
    const double longest_share = longest_share_of(recording, options);
    std::vector<Numbers> numbers;
    for (const std::vector<double>& signal : signals) { numbers.push_back({signal, code_step(signal)}); }
    Seen shortest = seen_in_blocks(recording, numbers, options.block_lengths.front(), longest_share, options);
    if (shortest.blocks.empty()) { return {}; }
    for (const std::size_t times : std::span(options.block_lengths).subspan(1)) {
        take_over(seen_in_blocks(recording, numbers, times, longest_share, options), shortest);
    }
    if (std::ranges::count(shortest.disturbed, true) == 0) { return {}; }
    std::vector<Course> courses;
    courses.reserve(numbers.size());
    for (const Numbers& signal : numbers) {
        courses.push_back(
            course_of(signal.values, shortest.blocks, power_of_codes(signal.step), longest_share, options));
    }
    std::vector<Disturbance> found =
        stretches(recording, shortest, courses, and_neighbours(shortest.disturbed));
    const auto rows = static_cast<double>(recording.rows());
    std::erase_if(
        found, [&](const Disturbance& one) { return static_cast<double>(one.rows) > longest_share * rows; });
    double together = 0.0;
    for (const Disturbance& one : found) { together += static_cast<double>(one.rows); }
    return together > options.together_share * rows ? std::vector<Disturbance>{} : found;
}

}  // namespace gyrolog
