// Test side only: the two-sided spectrum of a sequence, estimated by averaging Hann-windowed periodograms.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

inline void fourier_transform(std::vector<std::complex<double>>& x) {
    const std::size_t n = x.size();  // a power of two
    for (std::size_t i = 1, j = 0; i < n; ++i) {
        std::size_t bit = n >> 1U;
        for (; (j & bit) != 0; bit >>= 1U) { j ^= bit; }
        j ^= bit;
        if (i < j) { std::swap(x[i], x[j]); }
    }
    for (std::size_t size = 2; size <= n; size *= 2) {
        for (std::size_t k = 0; k < size / 2; ++k) {
            const auto turn = std::polar(1.0, -2.0 * pi * static_cast<double>(k) / static_cast<double>(size));
            for (std::size_t i = k; i < n; i += size) {
                const auto odd = turn * x[i + size / 2];
                x[i + size / 2] = x[i] - odd;
                x[i] += odd;
            }
        }
    }
}

// Sum of periodograms of records of equal length (a power of two).
class SpectrumAverage {
public:
    explicit SpectrumAverage(std::size_t length) : sum_(length / 2) {}

    void add(std::span<const double> record) {
        const std::size_t n = record.size();
        double mean = 0.0;
        for (const double value : record) { mean += value / static_cast<double>(n); }
        std::vector<std::complex<double>> x(n);
        double window_power = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const double window =
                0.5 - 0.5 * std::cos(2.0 * pi * static_cast<double>(i) / static_cast<double>(n));
            window_power += window * window;
            x[i] = window * (record[i] - mean);
        }
        fourier_transform(x);
        for (std::size_t k = 0; k < sum_.size(); ++k) { sum_[k] += std::norm(x[k]) / window_power; }
        ++records_;
    }

    std::size_t length() const { return 2 * sum_.size(); }
    std::size_t records() const { return records_; }
    // In units^2 per (cycle/sample) at k / length() cycles per sample.
    double at(std::size_t k) const { return sum_[k] / static_cast<double>(records_); }

private:
    std::vector<double> sum_;
    std::size_t records_ = 0;
};

struct OctaveRatio {
    double from_nu;  // cycles per sample
    double ratio;    // estimate over expectation, averaged over the octave's bins
    double sd;       // of the ratio, from the number of averages
};

// From bin 2 (the window spreads the removed mean over bins 0 and 1) to the Nyquist frequency.
template <typename Expected>
std::vector<OctaveRatio> octave_ratios(const SpectrumAverage& spectrum, Expected expected_psd) {
    std::vector<OctaveRatio> octaves;
    for (std::size_t first = 2; first < spectrum.length() / 2; first *= 2) {
        double sum = 0.0;
        for (std::size_t k = first; k < 2 * first; ++k) {
            sum += spectrum.at(k) /
                   expected_psd(static_cast<double>(k) / static_cast<double>(spectrum.length()));
        }
        const auto bins = static_cast<double>(first);
        // A periodogram bin scatters by its own size; the Hann window makes neighbours share: 35/18 of the
        // variance.
        const double sd = std::sqrt(35.0 / 18.0 / (bins * static_cast<double>(spectrum.records())));
        octaves.push_back({bins / static_cast<double>(spectrum.length()), sum / bins, sd});
    }
    return octaves;
}

}  // namespace gyrolog
