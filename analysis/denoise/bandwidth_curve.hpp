// What a denoising method does to white noise and to the rate, once it has settled: worked out from its
// answers to single samples, not measured.
#pragma once

#include <vector>

#include "analysis/denoise/array_denoiser.hpp"

namespace gyrolog {

struct FilterResponse {
    // Variance of the output over the mean variance of the units, for white noise of the units'
    // covariance. Of the wavelet: with all details below the threshold.
    double noise_ratio = 1.0;
    double lag_s = 0.0;          // of a slowly changing rate
    double half_power_hz = 0.0;  // where half of the rate's power is passed; 0: it passes up to rate / 2
};

// Of an adaptive rate: the response in motion, when the widest of its models holds.
FilterResponse filter_response(const ArrayNoise& noise, const DenoiseDesign& design);
// Of an adaptive rate: what it tends to at rest, when the narrowest of its models holds. As above of others.
FilterResponse calm_response(const ArrayNoise& noise, const DenoiseDesign& design);

struct BandwidthPoint {
    double bandwidth_hz = 0.0;
    FilterResponse kalman;
    FilterResponse joint;
};

// Of a walk or a trend, with bandwidths from rate / 1000 to rate / 4.
std::vector<BandwidthPoint> bandwidth_curve(const ArrayNoise& noise, const DenoiseDesign& design,
                                            RateModel model);

}  // namespace gyrolog
