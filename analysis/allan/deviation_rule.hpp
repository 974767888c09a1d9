// What the kinds of deviation have in common, as a table: each is the root of a mean of squared differences
// of the integrated signal theta.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct DeviationRule {
    DeviationKind kind = DeviationKind::overlapping;
    std::string_view name;
    int order = 2;             // of the differences over m: 2 Allan, 3 Hadamard
    bool overlapping = true;   // one difference at every sample; else at every m-th
    bool window_mean = false;  // each the mean of m neighbouring differences
    bool reflected = false;    // theta continued beyond its ends by reflection about them
    bool halving = false;      // m = 1, 2, 4, ... where the caller names none, and the textbook's error

    std::int64_t stride(std::int64_t m) const { return overlapping ? 1 : m; }

    // A term needs theta_k ... theta_{k + reach}. With reflection: what the points between the ends need.
    std::int64_t reach(std::int64_t m) const { return order * m + (window_mean ? m - 1 : 0); }

    // Of `points` consecutive points of theta; 0 where there is none.
    std::int64_t terms(std::int64_t points, std::int64_t m) const;

    // sigma^2 = sum of squares / (terms norm): m^2 times 2 (order 2) or 6 (order 3), for white rate noise to
    // give the same at any order; m^2 more where a mean is taken.
    double norm(std::int64_t m) const;
};

const DeviationRule& rule_of(DeviationKind kind);

// The terms in one unbroken stretch: the first k, counted from the stretch's theta_0, and their number. Terms
// that are strided lie on the record's grid, whose origin is the first sample of the first segment.
struct TermRun {
    std::int64_t begin = 0;
    std::int64_t terms = 0;
};
TermRun run_of(const DeviationRule& rule, std::span<const Segment> segments, std::size_t segment,
               PhaseConvention convention, std::int64_t m);

// The numbers of terms in the stretches that have any.
std::vector<std::int64_t> terms_of_runs(const DeviationRule& rule, std::span<const Segment> segments,
                                        PhaseConvention convention, std::int64_t m);

}  // namespace gyrolog
