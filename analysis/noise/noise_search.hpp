// Which terms a record's likelihood is made of: from N, B and K the model grows and narrows as the data call
// for it (likelihood_fit.hpp says by what rules).
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "analysis/noise/likelihood_fit.hpp"
#include "analysis/noise/likelihood_maximum.hpp"
#include "analysis/noise/noise_fit.hpp"

namespace gyrolog {

// Twice the gain of the log likelihood, beyond which a coefficient is identified: 2.6 standard deviations,
// 0.5 % by chance. An optional term must gain more, since the others lose precision by it.
inline constexpr double identified_ratio = 6.6;
inline constexpr double optional_ratio = 10.8;

// What the likelihood is made of, in the order of its components: N, B, K, then the optional ones.
struct SpectrumModel {
    bool ramp = false;
    bool angle_noise = false;
    std::vector<double> correlations_s;  // of Gauss-Markov terms
    std::vector<FittedSinusoid> lines;
    double upper_hz = std::numeric_limits<double>::infinity();
    double bandwidth_hz = 0.0;  // of the filter that the white noise came through; 0: none that is known
    double error = 0.0;

    std::size_t angle_noise_at() const { return 3; }
    std::size_t gauss_markov_at(std::size_t i) const { return 3U + (angle_noise ? 1U : 0U) + i; }
    std::size_t components() const { return gauss_markov_at(correlations_s.size()) + lines.size(); }
};

NoiseLikelihood likelihood_of(const ContrastPyramid& pyramid, const SpectrumModel& model);

// Fitted components of one model.
struct Fitted {
    SpectrumModel model;
    LikelihoodMaximum maximum;

    double value() const { return maximum.value; }
};

struct RampFit {
    Fitted fitted;
    RampEstimate ramp;
    double ratio = 0.0;  // twice the gain of the log likelihood
};

struct SearchResult {
    Fitted fitted;  // with the ramp where it is called for
    RampFit ramp;   // with the ramp in any case
};

// `start`: squares to begin with come from its coefficients. The value of `fitted` is -inf where no
// likelihood could be worked out.
SearchResult search_terms(const ContrastPyramid& pyramid, const NoiseFit& start,
                          const LikelihoodFitOptions& options);

// Whether a ramp is called for.
bool is_significant(const RampFit& ramp);

// `base` is a model without Q: the same with Q beside its terms, fitted.
Fitted with_angle_noise_added(const ContrastPyramid& pyramid, const Fitted& base);

// Of white noise, flicker and random walk, those that the record does call for, together: N and whichever of
// B, K, or both leaves most of twice the log likelihood after 4 for each. B and K stand in for each other, so
// that neither may be needed beside the other where one of them is.
LikelihoodMaximum with_needed_terms(const ContrastPyramid& pyramid, const Fitted& fitted);

}  // namespace gyrolog
