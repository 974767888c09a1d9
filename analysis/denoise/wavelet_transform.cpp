#include "analysis/denoise/wavelet_transform.hpp"

#include <algorithm>
#include <array>

namespace gyrolog {
namespace {

// Low-pass of the synthesis, from its first tap.
constexpr std::array<double, wavelet_taps> low{
    0.23037781330889650,  0.71484657055291565, 0.63088076792985891, -0.02798376941685985,
    -0.18703481171909309, 0.03084138183556076, 0.03288301166688520, -0.01059740178506903};

// High-pass: the same taps backwards, with every second sign changed.
constexpr std::array<double, wavelet_taps> high = [] {
    std::array<double, wavelet_taps> taps{};
    for (std::size_t i = 0; i < wavelet_taps; ++i) {
        taps[i] = (i % 2 == 0 ? 1.0 : -1.0) * low[wavelet_taps - 1 - i];
    }
    return taps;
}();

// The place in a signal of n samples that lies at `i` in its mirrored continuation.
std::size_t mirrored(std::ptrdiff_t i, std::size_t n) {
    const auto period = static_cast<std::ptrdiff_t>(2 * n);
    i %= period;
    if (i < 0) { i += period; }
    return static_cast<std::size_t>(i < static_cast<std::ptrdiff_t>(n) ? i : period - 1 - i);
}

}  // namespace

int levels_of(std::size_t samples) {
    int levels = 0;
    while (samples >= (wavelet_taps - 1) << static_cast<unsigned>(levels + 1)) { ++levels; }
    return levels;
}

void analyse_level(std::span<const double> signal, std::span<double> approximation,
                   std::span<double> detail) {
    for (std::size_t k = 0; k < approximation.size(); ++k) {
        double a = 0.0;
        double d = 0.0;
        // Sample 2 k - 6 + i meets tap i of the synthesis filters, which is the analysis' one backwards.
        if (2 * k >= wavelet_taps - 2 && 2 * k + 1 < signal.size()) {
            const double* samples = signal.data() + (2 * k - (wavelet_taps - 2));
            for (std::size_t i = 0; i < wavelet_taps; ++i) {
                a += low[i] * samples[i];
                d += high[i] * samples[i];
            }
        } else {
            for (std::size_t i = 0; i < wavelet_taps; ++i) {
                const auto place =
                    static_cast<std::ptrdiff_t>(2 * k + i) - static_cast<std::ptrdiff_t>(wavelet_taps - 2);
                const double sample = signal[mirrored(place, signal.size())];
                a += low[i] * sample;
                d += high[i] * sample;
            }
        }
        approximation[k] = a;
        detail[k] = d;
    }
}

void restore_level(std::span<const double> approximation, std::span<const double> detail, std::size_t first,
                   std::span<double> samples) {
    for (std::size_t j = 0; j < samples.size(); ++j) {
        const std::size_t at = first + j + wavelet_taps - 2;  // of the sample among the taps of coefficient 0
        const std::size_t begin = at < wavelet_taps ? 0 : (at - wavelet_taps + 2) / 2;
        const std::size_t end = std::min(at / 2 + 1, approximation.size());
        double sum = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            sum += approximation[k] * low[at - 2 * k] + detail[k] * high[at - 2 * k];
        }
        samples[j] = sum;
    }
}

}  // namespace gyrolog
