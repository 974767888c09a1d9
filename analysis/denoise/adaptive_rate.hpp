// A rate that is calm for long and then moves: four trends (rate_model.hpp), from a fiftieth to the whole
// of a bandwidth, run together as interacting multiple models (H. A. P. Blom and Y. Bar-Shalom, "The
// interacting multiple model algorithm for systems with Markovian switching coefficients", IEEE Trans. Autom.
// Control 33 (1988) 780-783). Each sample's likelihood under each model says which of them holds; the rate is
// their mean by those probabilities. Narrow bands take the noise out while nothing happens, and within a few
// samples of a motion that they cannot follow the wide one has taken over.
//
// A model is kept from one sample to the next with probability 0.998: calm and motion last some 500 samples
// or longer.
#pragma once

#include <array>
#include <cstddef>

namespace gyrolog {

inline constexpr std::size_t adaptive_models = 4;
inline constexpr std::array<double, adaptive_models> adaptive_bandwidths = {0.02, 0.08, 0.3,
                                                                            1.0};  // of the widest

// No allocation.
class AdaptiveRate {
public:
    // `bandwidth_hz`: the widest, less than half the rate. `variance`: of the white noise of a sample.
    AdaptiveRate(double bandwidth_hz, double rate_hz, double variance);

    // `variance`: of this sample.
    double step(double sample, double variance);
    // The next sample is the first.
    void reset() { fresh_ = true; }

    double slope() const { return slope_; }  // change per sample
    double slope_sd() const { return slope_sd_; }
    // Of each model at the last sample, the narrowest first.
    const std::array<double, adaptive_models>& probabilities() const { return probability_; }

private:
    struct Model {
        double intensity = 0.0;  // variance of the change of the slope
        double rate = 0.0, slope = 0.0;
        double p00 = 0.0, p01 = 0.0, p11 = 0.0;  // covariance of rate and slope
    };

    void begin(double sample, double variance);
    std::array<Model, adaptive_models> mixed(const std::array<double, adaptive_models>& predicted) const;
    static double update(Model& model, double sample, double variance);  // returns the log likelihood
    void combine();

    std::array<Model, adaptive_models> models_;
    std::array<double, adaptive_models> probability_{};
    bool fresh_ = true;
    double rate_ = 0.0;
    double slope_ = 0.0;
    double slope_sd_ = 0.0;
};

}  // namespace gyrolog
