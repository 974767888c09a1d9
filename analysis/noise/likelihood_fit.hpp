// Noise coefficients from the samples themselves, by likelihood (noise_likelihood.hpp).
//
// N, B and K are always free. Q, the ramp R, Gauss-Markov noise and sinusoids come in only where the data
// call for them, so that what is absent does not blur what is there. Intervals are by profile likelihood,
// standard deviations by the expected information; beside them the Cramer-Rao bound of the whole record under
// the fitted model, for components with squares theta and spectra S_j (Whittle, Ark. Mat. 2 (1953) 423-434):
//   I_ij = T integral from 1 / 2T to rate / 2 of S_i S_j / S^2 df
//
// A real sensor departs from any model somewhere, at high frequencies most visibly, where contrasts are many.
// The size of that departure is estimated, and each contrast is weighted as its chance and this departure
// together deserve. Where it is large because the upper end of the band is filtered or noisy, that end is
// left out, and the fit says so.
//
// Where the sensor's own low-pass filter is known and acts below half the rate, the white noise is that
// behind a Butterworth filter of the second order, and all above a fifth of the bandwidth is left out from
// the start: of which order a sensor's filter is, is not known. Averages of neighbours see some of what lies
// above.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/noise/noise_fit.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct LikelihoodFitOptions {
    double confidence = 0.683;
    std::vector<FittedSinusoid> lines{};  // known to be there
    // Step of the converter, in the column's unit; its error is taken as white noise of variance step^2 / 12
    // (Widrow and Kollar, Quantization Noise, 2008, where the noise spans some 0.4 of the step or more) and
    // is not part of N. 0: not known or none.
    double step = 0.0;
    double bandwidth_hz = 0.0;  // -3 dB of the sensor's low-pass filter; 0: not known or none
    // Of the rate: a filter that is at least as wide leaves the noise as it is. Chosen: what it would take
    // off the upper end folds back from beyond half the rate.
    double filter_acts_below = 0.4;
    // Of the bandwidth: so far a filter is flat. A Butterworth filter of the first order takes off 4 % of the
    // power there, 1/(1 + 0.2^2), one of the second 0.16 %.
    double filter_flat_up_to = 0.2;
};

// `start`: a fit to the record's Allan curve. Nothing for fewer than 32 samples, or samples that do not vary:
// then the curve is all there is.
std::optional<NoiseFit> fit_likelihood(const Column& column, std::span<const Segment> segments,
                                       double rate_hz, const NoiseFit& start,
                                       const LikelihoodFitOptions& options = {});

}  // namespace gyrolog
