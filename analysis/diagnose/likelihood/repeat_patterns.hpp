// Repeat patterns tell which quantities of a sample repeat those of the sample before: bit c of a pattern is
// set where quantity c repeats.
//
// The model: a share eps of the samples repeats in all quantities of a set at once. Apart from that, each
// quantity repeats by chance, independently of the others, at a rate of its own in every block of time: a
// rounded value repeats the more often, the less it moves.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog {

// The axes and the thermometer.
inline constexpr std::size_t repeat_quantities_max = gyro_columns.size() + 1;
inline constexpr std::size_t repeat_patterns = 1U << repeat_quantities_max;

using PatternCounts = std::array<double, repeat_patterns>;

// A range knows a quantity's ends. Clipped samples are equal, too: at its ends a quantity repeats because it
// goes no further.
template <typename Value>
class ValueRange {
public:
    explicit ValueRange(const std::vector<Value>& values)
        : lowest_(std::ranges::min(values)), highest_(std::ranges::max(values)) {}

    bool ends_at(Value value) const { return lowest_ < highest_ && (value == lowest_ || value == highest_); }

private:
    Value lowest_;
    Value highest_;
};

// By row.
using RowPatterns = std::vector<std::uint8_t>;

// The pattern of each row against the `lag`-th before it; 0 where that belongs to another segment. A
// quantity's lowest and highest value count as no repeats.
RowPatterns row_patterns(const Recording& recording, const std::vector<const Column*>& quantities,
                         std::size_t lag);

// The patterns of some of the quantities, named by their places.
RowPatterns patterns_of_some(const RowPatterns& patterns, std::span<const std::size_t> quantities);

// Rows that repeat in all quantities one after the other are one sample shown again and again: in `apart`,
// the patterns of a lag above 1, the function clears those within such a run. `next`: the patterns of lag 1.
void leave_out_runs(const RowPatterns& next, std::size_t quantities, RowPatterns& apart);

// The function counts the rows whose `lag`-th before belongs to the same segment, by pattern, in `blocks`
// equal blocks of rows.
std::vector<PatternCounts> count_patterns(const Recording& recording, const RowPatterns& patterns,
                                          std::size_t lag, std::size_t blocks);

// The number of all patterns that contain `set`, and of all there are.
double count_containing(const PatternCounts& counts, std::size_t set);
double count_all(const PatternCounts& counts);

struct RepeatFit {
    double eps = 0.0;
    double log_likelihood_nats = 0.0;
};

// The functions find the most likely chance rates for a given eps, and the most likely eps, by expectation
// maximisation. `set` has two quantities or more: eps and the chance of a single one cannot be told apart.
RepeatFit fit_chance(const std::vector<PatternCounts>& blocks, std::size_t quantities, std::size_t set,
                     double eps);
RepeatFit fit_repeats(const std::vector<PatternCounts>& blocks, std::size_t quantities, std::size_t set);

}  // namespace gyrolog
