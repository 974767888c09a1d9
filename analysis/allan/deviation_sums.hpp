// Sums of squares for every kind of deviation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/difference_sums.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

// theta of each unbroken stretch of a column.
struct IntegratedSignal {
    IntegratedSignal(const Column& column, std::span<const Segment> segments, PhaseConvention convention);

    std::span<const Segment> segments;
    PhaseConvention convention;
    std::vector<Stretch> stretches;  // one a segment
};

// For each m, over all terms of all stretches. No stretch is copied. The result does not depend on `threads`.
// Time is that of a few operations for each point and m, whatever m is.
std::vector<double> deviation_sums(const IntegratedSignal& signal, const DeviationRule& rule,
                                   std::span<const std::int64_t> m, unsigned threads);

}  // namespace gyrolog
