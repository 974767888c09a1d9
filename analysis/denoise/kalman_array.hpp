// Kalman filter of an array of gyros that measure the same rate: z_i = rate + bias_i + white noise, biases
// random walks, after Peng and Chen, "Application of joint filtering algorithm in noise reduction of MEMS
// gyro" (Transducer and Microsystem Technologies, 2022, no. 3), section 1.
//
// A common change of all biases looks like a change of the rate, so what such an array shows is
//   s   = rate + v' bias            the fused rate, v = Q^-1 1 / (1' Q^-1 1), Q the biases' walk
//   d_i = bias_i - v' bias          N - 1 offsets between the units, v' d = 0
// and no more. In these states everything is observable, the Riccati equation has its stabilising solution,
// and s and d wander independently of each other. The fused rate has the bias v' bias: a constant rate passes
// unchanged, and so does the mean turn-on bias.
//
// A rate that is `free` is an unknown input: offsets are followed by what differs between the units, and the
// rate is the best linear unbiased combination of the units less their offsets,
//   s = a' (z - d),  a = S^-1 1 / (1' S^-1 1),  S = P_d + R
// (S. Gillijns and B. De Moor, "Unbiased minimum-variance input and state estimation for linear discrete-time
// systems with direct feedthrough", Automatica 43 (2007) 934-937). One unit gives its own samples; equal
// units give their mean.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "analysis/denoise/array_noise.hpp"
#include "analysis/denoise/rate_model.hpp"

namespace gyrolog {

enum class FilterGain {
    varying,  // from nothing known about rate and offsets, by the covariance of each sample
    steady,   // the settled gain from the first sample on, with offsets given
};

// No allocation after construction.
class KalmanArray {
public:
    // 1 to units_max units with white noise; a bandwidth that `design` may have; `adaptive` is as `free`:
    // it comes behind this filter. `offsets`: of the units
    // about their weighted mean, where they are known; a varying gain finds them by itself.
    KalmanArray(const ArrayNoise& noise, const RateDesign& design, FilterGain gain = FilterGain::varying,
                std::span<const double> offsets = {});
    ~KalmanArray();
    KalmanArray(const KalmanArray&) = delete;
    KalmanArray& operator=(const KalmanArray&) = delete;
    KalmanArray(KalmanArray&&) noexcept;
    KalmanArray& operator=(KalmanArray&&) noexcept;

    std::size_t units() const;
    // The fused rate at this sample. `used[i]` false leaves unit i out; where all are, the rate is predicted.
    double step(std::span<const double> rates, std::span<const std::uint8_t> used);
    double step(std::span<const double> rates);
    // Samples that nobody took: the rate is unknown again, the offsets have wandered.
    void skip(std::size_t samples);

    // Change of the rate per sample, and its standard deviation; 0 unless the rate is a trend.
    double slope() const;
    double slope_sd() const;
    // Of unit i about the fused rate, and its standard deviation.
    double offset(std::size_t unit) const;
    double offset_sd(std::size_t unit) const;
    // Standard deviation of the fused rate about rate + v' bias; of a free rate that of the combination.
    double rate_sd() const;
    double settled_rate_sd() const;
    // The settled weights of the units in the fused rate at once (gain) and in the long run (v).
    std::vector<double> sample_weights() const;
    std::vector<double> drift_weights() const;

    // Of the last step: measured less predicted, and their squared length by their covariance, chi-square
    // with as many degrees of freedom as units (one fewer of a free rate: what differs between them).
    std::span<const double> innovations() const;
    double innovation_power() const;
    bool is_settled() const;
    // Covariance that the gain at present rests on, and the settled one, before the measurement: of
    // (rate, slope, offsets) as far as they are states. Row by row.
    std::vector<double> covariance() const;
    std::vector<double> settled_covariance() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace gyrolog
