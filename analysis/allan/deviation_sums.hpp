// Sums of squares for every kind of deviation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/difference_sums.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

// theta of each unbroken stretch of a column, and where it begins on the grid.
struct IntegratedSignal {
    IntegratedSignal(const Column& column, std::span<const Segment> segments, PhaseConvention convention);

    // The first k of a stretch at which a term is taken, and the number of terms.
    struct Run {
        std::int64_t begin = 0;
        std::int64_t terms = 0;
    };
    Run run(const DeviationRule& rule, std::size_t stretch, std::int64_t m) const;
    // Terms of every stretch.
    std::vector<std::int64_t> terms(const DeviationRule& rule, std::int64_t m) const;

    std::vector<Stretch> stretches;
    std::vector<std::int64_t> first_index;  // of each stretch's theta_0, counted from the record's start
    std::int64_t longest = 0;               // samples
};

// For each m, over all terms of all stretches. No stretch is copied. The result does not depend on `threads`.
// Time is that of a few operations for each point and m, whatever m is.
std::vector<double> deviation_sums(const IntegratedSignal& signal, const DeviationRule& rule,
                                   std::span<const std::int64_t> m, unsigned threads);

}  // namespace gyrolog
