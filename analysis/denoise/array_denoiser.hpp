// One axis of an array of gyros, denoised sample by sample: watch (unit_watch.hpp), Kalman filter
// (kalman_array.hpp), wavelet threshold (wavelet_denoiser.hpp).
//
//   kalman    the array filter alone; the rate is free unless a bandwidth is given
//   wavelet   the units combined with a free rate, then the wavelet
//   joint     the array filter with a bandwidth, then the wavelet, with a threshold of each level's own
//             because what leaves the filter is not white, and, for a rate with a trend, along the filter's
//             slope where that is beyond its own noise (3.3 standard deviations, as a detail must be)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/denoise/adaptive_rate.hpp"
#include "analysis/denoise/kalman_array.hpp"
#include "analysis/denoise/unit_watch.hpp"
#include "analysis/denoise/wavelet_denoiser.hpp"

namespace gyrolog {

enum class DenoiseMethod { kalman, wavelet, joint };
inline constexpr std::array all_denoise_methods = {DenoiseMethod::kalman, DenoiseMethod::wavelet,
                                                   DenoiseMethod::joint};

std::string_view name_of(DenoiseMethod method);
std::optional<DenoiseMethod> denoise_method(std::string_view name);

struct DenoiseDesign {
    DenoiseMethod method = DenoiseMethod::joint;
    RateDesign rate;  // of kalman and joint
    FilterGain gain = FilterGain::varying;
    std::size_t window = 256;  // of the wavelet
    int levels = 4;
    bool watch = true;  // leave units out that fail
};

// What a method is when nobody says otherwise: kalman passes every rate; joint is adaptive, up to a fourth of
// the sampling rate.
RateDesign default_rate_design(DenoiseMethod method, double rate_hz);

// Of the design's wavelet.
WaveletOptions wavelet_options(const DenoiseDesign& design);

// No allocation after construction.
class ArrayDenoiser {
public:
    // `limits`: of each unit.
    ArrayDenoiser(const ArrayNoise& noise, std::span<const UnitLimits> limits, const DenoiseDesign& design,
                  std::span<const double> offsets = {});

    // One value a unit, NaN where it has none; the rate without delay by this class.
    double step(std::span<const double> rates);
    void skip(std::size_t samples);

    // At the last step.
    std::span<const UnitState> states() const { return states_; }
    const KalmanArray& filter() const { return filter_; }

private:
    DenoiseDesign design_;
    KalmanArray filter_;
    std::optional<AdaptiveRate> adaptive_;
    UnitWatch watch_;
    WaveletDenoiser wavelet_;
    std::span<const UnitState> states_;
    std::array<std::uint8_t, units_max> used_{};
    std::array<double, units_max> offsets_{};
    std::size_t since_gap_ = 0;  // samples
};

}  // namespace gyrolog
