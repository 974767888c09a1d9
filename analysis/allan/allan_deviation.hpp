// Deviations of the Allan family, of a uniformly sampled signal with holes.
//
//   theta_k = x_1 + ... + x_k,  theta_0 = 0     integrated signal, N + 1 points for N samples
//   d_k = theta_{k+2m} - 2 theta_{k+m} + theta_k,   h_k = d_{k+m} - d_k
//
//   overlapping            mean over every k of d_k^2 / (2 m^2)                     NIST SP 1065 eq. 11
//   standard               the same over every m-th k                               eqs. 6, 7
//   standard_halving       as standard, at m = 1, 2, 4, ...: pairs averaged again and again
//   modified               mean over j of (d_j + ... + d_{j+m-1})^2 / (2 m^4)       eq. 14
//   hadamard               mean over every m-th k of h_k^2 / (6 m^2)                eqs. 17, 18
//   overlapping_hadamard   the same over every k                                    eq. 20
//   total                  mean over i = 1 ... N - 1 of (theta*_{i+m} - 2 theta*_i + theta*_{i-m})^2 / (2
//   m^2),
//                          theta* = theta reflected about its first and its last point   eq. 25
//
// give the square, with tau = m / rate. The first two are IEEE Std 952-1997 annex C for gyros. A term is used
// only where all its samples exist, on the record's true time grid (every m-th: of that grid). Total
// deviation reflects each unbroken stretch of 2m samples or more about its own ends, and averages over the
// terms of all of them. Sums over sensor counts are exact up to the squares, those of `overlapping` to the
// end. Unit: the column's.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/recording/stage_observer.hpp"

namespace gyrolog {

struct AllanOptions {
    DeviationKind kind = DeviationKind::overlapping;
    PhaseConvention convention = PhaseConvention::sp1065;
    double confidence = 0.683;      // of the two-sided interval, between 0 and 1
    std::vector<std::int64_t> m{};  // averaging factors; empty: averaging_factors() of the longest segment,
                                    // or the powers of two for standard_halving
    bool every_m = false;           // instead of those, all from 1 to half the longest segment; the time
                                    // taken grows with the square of the record's length
    unsigned threads = 1;           // 0: all processors; the result is the same bits for any number
    bool intervals = true;          // false: lo, hi and edf stay 0, which saves most of the time on short
                                    // records
    StageObserver on_stage{};       // of "integrate", "deviation", "intervals"
};

// Factors for which the record has no complete term give no point. Samples that are all equal give deviations
// of 0, with intervals of 0 length.
//
// `total` is given as the formula says, without removal of its bias (total_variance.hpp: low by
// 0.481 tau / T of the variance for flicker and 0.750 tau / T for walking rate); its interval has it removed.
//
// Intervals are those of intervals.hpp, for the power laws fitted to the record's own overlapping curve
// (power_law_levels.hpp).
AllanCurve allan_deviation(const Column& column, std::span<const Segment> segments, double rate_hz,
                           const AllanOptions& options = {});

}  // namespace gyrolog
