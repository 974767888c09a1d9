// The complete noise model of an Allan curve of which only the numbers are known: read off a figure, or out
// of a table. There are no samples and no degrees of freedom.
//
// What is fitted: 20 log10 of the deviation, by least squares, because reading errors are relative. What is
// left over is taken as the sum of
//   - reading errors, independent from point to point, of 2 % (0.17 dB) unless told otherwise, and
//   - a smooth part of unknown size s, correlation exp(-|ln(tau_i / tau_j)| / ln 2): the scatter of the
//   record
//     itself, which neighbouring averaging times share, and whatever the model does not follow.
// s is fitted by maximum likelihood. Without it 60 points that share one wiggle would count as 60 witnesses.
//
// Which terms: from N, B and K, the one term is added that lowers Schwarz's criterion most,
//   BIC = -2 ln(likelihood) + k ln(points)                                   (Schwarz 1978)
// with k = 1 for each of Q, N, B, K, R and 2 for a Gauss-Markov process (size, correlation time) or a
// sinusoid (amplitude, frequency), as long as it falls by more than 6, "strong" by Kass and Raftery (1995),
// table 2; the margin pays for having searched all frequencies. After each step terms leave that no longer
// pay for themselves: those without which BIC rises by less than 2 ("positive").
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/noise/noise_fit.hpp"
#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

// One term of a noise model.
struct CurveTerm {
    enum class Kind { Q, N, B, K, R, gauss_markov, sinusoid };
    Kind kind = Kind::N;
    double size = 0.0;   // Q, N, B, K or R, sigma of Gauss-Markov noise, amplitude of a sinusoid
    double shape = 0.0;  // correlation time in s, frequency in Hz; 0 for the others

    double allan_variance(double tau_s) const;
    // Where the term's Allan deviation is highest; 0 for terms without a hump.
    double hump_tau_s() const;
};

// Whether the term is told by a second number.
constexpr bool has_shape(CurveTerm::Kind kind) {
    return kind == CurveTerm::Kind::gauss_markov || kind == CurveTerm::Kind::sinusoid;
}

std::string_view name_of(CurveTerm::Kind kind);  // "Q", ..., "Gauss-Markov", "sinusoid"

inline constexpr double variance_db_per_neper = 10.0 / std::numbers::ln10;  // of a variance

// How far a curve lies from a model, in dB of deviation: 20 log10(curve / model).
struct CurveResidual {
    double rms_db = 0.0;
    double worst_db = 0.0;  // with its sign
    double worst_tau_s = 0.0;
};

struct CurveFitStep {
    enum class Change { start, added, removed };
    Change change = Change::start;
    CurveTerm::Kind term = CurveTerm::Kind::N;  // that came or went
    std::vector<CurveTerm> terms;               // after the step
    CurveResidual residual;
    double criterion = 0.0;  // BIC
};

// A term that was tried after the last step, and not called for.
struct RejectedTerm {
    CurveTerm term;
    double criterion_gain = 0.0;  // by which BIC would fall; not more than the margin
    double rms_db = 0.0;          // of the curve about the model with it
};

struct CurveFitOptions {
    double confidence = 0.683;
    double reading_error = 0.02;  // one sigma, relative
};

struct CurveModelFit {
    NoiseFit noise;  // `best` and `sparse` are the same here: the terms of the last step
    std::vector<CurveTerm> terms;
    CurveResidual residual;
    double smooth_sd_db = 0.0;  // s above
    std::vector<CurveFitStep> steps;
    std::vector<RejectedTerm> rejected;
};

inline constexpr std::size_t curve_fit_points_min = 4;

// Points without a positive deviation and averaging time are left out. Fewer than curve_fit_points_min give a
// fit without terms.
CurveModelFit fit_curve_model(const AllanCurve& curve, const CurveFitOptions& options = {});

}  // namespace gyrolog
