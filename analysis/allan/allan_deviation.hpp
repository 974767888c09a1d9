// Allan deviation of a uniformly sampled signal with holes.
//
//   theta_k = x_1 + ... + x_k,  theta_0 = 0     integrated signal, N + 1 points for N samples
//   d_k = theta_{k+2m} - 2 theta_{k+m} + theta_k
//   sigma^2(m tau0) = sum_k d_k^2 / (2 m^2 terms)
//
// overlapping: every k (NIST SP 1065 eq. 11, written for samples of rate); standard: every m-th k (eq. 10).
// Both as in IEEE Std 952-1997 annex C for gyros. A difference is used only where all its 2m samples exist,
// on the record's true time grid. Sums over sensor counts are exact up to the squares. Unit: the column's.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct AllanOptions {
    DeviationKind kind = DeviationKind::overlapping;
    PhaseConvention convention = PhaseConvention::sp1065;
    double confidence = 0.683;      // of the two-sided interval, between 0 and 1
    std::vector<std::int64_t> m{};  // averaging factors; empty: averaging_factors() of the longest segment
    unsigned threads = 1;           // the result is the same bits for any number
};

// Factors for which the record has no complete difference give no point.
//
// Intervals: edf sigma^2 / sigma_true^2 is taken as chi-square, with the equivalent degrees of freedom of the
// power law identified at that averaging time (power_law.hpp) or at a shorter one, whichever has the longer
// memory.
AllanCurve allan_deviation(const Column& column, std::span<const Segment> segments, double rate_hz,
                           const AllanOptions& options = {});

}  // namespace gyrolog
