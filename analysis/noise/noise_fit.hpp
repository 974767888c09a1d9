// Noise coefficients with their uncertainties, fitted to an Allan curve.
//
// sigma^2(tau) = 3 Q^2 / tau^2 + N^2 / tau + (2 ln 2 / pi) B^2 + K^2 tau / 3 + R^2 tau^2 / 2
// (noise_model.hpp) is linear in the squares of the coefficients: non-negative least squares on the measured
// variances, weighted with edf / (2 sigma^4) of the fitted model (iterated; weights from the measured values
// would favour points that came out low). Averaging times overlap, so neighbouring points are correlated:
// uncertainties are the sandwich
//   (A' W A)^-1 A' W C W A (A' W A)^-1
// with C the covariance of Allan variance estimates under the fitted model.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

enum class NoiseTerm { Q, N, B, K, R };
inline constexpr std::size_t noise_terms = 5;
inline constexpr std::array<NoiseTerm, noise_terms> all_noise_terms = {
    NoiseTerm::Q, NoiseTerm::N, NoiseTerm::B, NoiseTerm::K, NoiseTerm::R};

std::string_view name_of(NoiseTerm term);

struct FittedCoefficient {
    enum class State {
        identified,        // value, sd, lo and hi hold
        not_identifiable,  // the record is too short or the term too small: `upper` holds
    };
    State state = State::not_identifiable;
    double value = 0.0;  // in the curve's unit times s (Q), sqrt(s) (N), 1 (B), 1/sqrt(s) (K), 1/s (R)
    double sd = 0.0;
    double lo = 0.0;  // two-sided interval at the fit's confidence
    double hi = 0.0;
    double upper = 0.0;  // upper end of that interval, by the scatter a value as large would have
    // What fits best, identified or not, never negative; and how far it moves where its square moves up by
    // one standard deviation, which near 0 is more than down.
    double estimate = 0.0;
    double estimate_sd = 0.0;
    double bound = 0.0;  // Cramer-Rao bound of the standard deviation under the fitted model; 0: not known
};

// Of a coefficient whose square was found to be `square` with a standard deviation.
void set_estimate(FittedCoefficient& fitted, double square, double square_sd);

struct FittedGaussMarkov {
    GaussMarkov value;
    double sigma_sd = 0.0;
    double correlation_sd_s = 0.0;
};

struct FittedSinusoid {
    Sinusoid value;
    double amplitude_sd = 0.0;
    double frequency_sd_hz = 0.0;
};

// How the coefficients were found.
enum class FitMethod {
    curve,       // weighted least squares on an Allan curve
    likelihood,  // likelihood of the samples
};

std::string_view name_of(FitMethod method);

struct NoiseFit {
    FitMethod method = FitMethod::curve;
    double confidence = 0.683;
    std::array<FittedCoefficient, noise_terms> terms;  // indexed by NoiseTerm
    // Correlation of the estimates of identified terms, indexed by NoiseTerm twice; 0 for the others.
    std::array<std::array<double, noise_terms>, noise_terms> correlation{};
    // Beyond Q, N, B, K and R, where the data call for them.
    std::vector<FittedGaussMarkov> gauss_markov;
    std::vector<FittedSinusoid> sinusoids;
    // The best-fitting curve: holds the estimates of terms that are not identifiable as well, so that it is
    // an unbiased description of the curve and no statement about them.
    NoiseModel best;
    // The fewest terms that do: what another record of this sensor should be expected to show.
    //   curve: the least significant term is left out and the rest fitted again, until all are at least one
    //     standard deviation above zero;
    //   likelihood: N, with whichever of B, K or both leaves most of twice the log likelihood after 4 for
    //     each; Q, R, Gauss-Markov noise and sinusoids as in `best`.
    NoiseModel sparse;
    std::size_t points = 0;  // of the curve that were used
    double worst_residual_sd =
        0.0;  // the largest departure of a point from the fitted curve, in its standard deviations
    // Degrees of freedom with which the Allan variance of the sparse model at the length of the whole record
    // is known; 0: not known.
    double mean_dof = 0.0;
    // Of a likelihood fit: the typical departure of the spectrum from the model beyond chance, as a share of
    // the model; and the frequency above which the record was left out, 0 for none.
    double model_error = 0.0;
    double upper_frequency_hz = 0.0;
    // -3 dB of the sensor's known low-pass filter, where the record was left out because of it; 0 otherwise.
    double bandwidth_hz = 0.0;
    // Where the record's spectrum departs most significantly from the model, and measured over modelled
    // density there.
    double worst_frequency_hz = 0.0;
    double worst_ratio = 1.0;

    const FittedCoefficient& operator[](NoiseTerm term) const {
        return terms[static_cast<std::size_t>(term)];
    }
    // The record's spectrum has hardly anything of the noise of a sensor at rest (model_error): it was in
    // motion, or shaken, and the coefficients mean nothing.
    bool is_of_motion() const;
    // The identified terms as they are reported; 0 for the others.
    NoiseModel identified() const;
};

// A term is identified when its square is more than 2 standard deviations above zero. Points without degrees
// of freedom (a curve from print) are weighted alike, relative to their height, as if each had 50. A curve
// without points gives no identified term and upper limits of 0.
NoiseFit fit_noise(const AllanCurve& curve, double confidence = 0.683);

}  // namespace gyrolog
