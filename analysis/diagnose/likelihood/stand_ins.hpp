// Stand-ins are values for samples that are missing, such as the noise of a stationary model would have
// there: drawn from what the model expects of them given the samples beside them (conditional simulation; H.
// Rue, L. Held, Gaussian Markov Random Fields, 2005, 2.3.1). Likelihoods of spectra take them for samples.
// A value that ignores its neighbours is an outlier behind a low-pass filter, and adds noise at frequencies
// that have hardly any.
#pragma once

#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"
#include "analysis/numerics/envelope_cholesky.hpp"
#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {

// The inverse of the covariance of stationary noise has in row i and column j the value at |i - j| of
//   c_k = integral of cos(2 pi f k / rate) / (S rate^2) df over the whole band.
struct InverseCovariance {
    std::vector<double> by_lag;  // c_0 ... c_lags, 1/(rad/s)^2
    double least = 0.0;          // No eigenvalue is below, 1/(rad/s)^2.
};

// `density`: S by bin, two-sided, in (rad/s)^2/Hz, of a record of `length` samples.
InverseCovariance inverse_covariance(const SpectralBins& bins, std::span<const double> density,
                                     double rate_hz, std::size_t length, std::size_t lags);

// The function draws new values for `slots`, which are the missing ones in their order: what the noise has
// them be given all others, with C the inverse covariance of all and M the missing ones x_M - C_MM^-1 (C
// x)_M, and noise of covariance C_MM^-1. `weighted`: C x by slot, in 1/(rad/s). C is `expectation` for the
// former, `scatter` for the latter. `noise` draws one number for each slot.
void draw_stand_ins(std::span<float> values, std::span<const std::size_t> slots,
                    std::span<const double> weighted, const InverseCovariance& expectation,
                    const InverseCovariance& scatter, const RandomStream& noise);

// Missing samples that are taken together, in the order of their slots, and the factor of their C_MM. What is
// taken together is eliminated from its end on: so the first of them do not depend on the last.
struct StandInPart {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t kept_end = 0;  // Those that follow tell of the ones before only.
    EnvelopeCholesky factor;
};

// The missing slots and the C_MM of one expectation, for many values. The factors are kept where they take no
// more than some 30 MB, and are else worked out each time.
class ExpectedStandIns {
public:
    ExpectedStandIns(std::vector<std::size_t> slots, InverseCovariance inverse);

    const std::vector<std::size_t>& slots() const { return slots_; }
    // The function sets the values of the slots to the expectation alone: x_M - C_MM^-1 (C x)_M, linear in
    // all values.
    void expect(std::span<float> values, std::span<const double> weighted) const;

private:
    std::vector<std::size_t> slots_;
    InverseCovariance inverse_;
    std::vector<StandInPart> parts_;  // empty where they are not kept
};

// The function adds noise of covariance C_MM^-1 to the values of the slots.
void scatter_stand_ins(std::span<float> values, std::span<const std::size_t> slots,
                       const InverseCovariance& inverse, const RandomStream& noise);

// The function returns the logarithm of the density of the values of `slots` given all others, in nats and
// without the factors 1 / sqrt(2 pi).
double stand_ins_log_density_nats(std::span<const std::size_t> slots, std::span<const double> weighted,
                                  const InverseCovariance& inverse);

}  // namespace gyrolog
