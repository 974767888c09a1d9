#include "analysis/denoise/wavelet_denoiser.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/denoise/wavelet_transform.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t least_window = 2 * (wavelet_taps - 1);
constexpr double median_of_normal_sizes = 0.6744897501960817;
constexpr std::size_t windows_kept = 8;

// Which of a level's coefficients the samples from `first` on rest on.
std::size_t first_coefficient(std::size_t first) { return first / 2; }

}  // namespace

WaveletDenoiser::WaveletDenoiser(const WaveletOptions& options) : options_(options) {
    options_.window = std::max(options_.window, least_window);
    past_.resize(windows_kept * options_.window);
    level_.resize(options_.window);
    std::size_t size = options_.window;
    for (int level = 0; level < options_.levels; ++level) {
        size = coefficients_of(size);
        levels_.push_back({std::vector<double>(size), std::vector<double>(size), 0});
    }
    sizes_.resize(coefficients_of(options_.window));
    restored_.resize(2 * wavelet_taps);
}

double WaveletDenoiser::step(double sample, double slope) {
    if (end_ == past_.size()) {
        const std::size_t kept = std::min(samples_, options_.window - 1);
        std::copy(past_.end() - static_cast<std::ptrdiff_t>(kept), past_.end(), past_.begin());
        end_ = kept;
    }
    past_[end_++] = sample;
    samples_ = std::min(samples_ + 1, options_.window);
    if (samples_ < least_window) { return sample; }
    const std::span<double> window = std::span(level_).first(samples_);
    const double* oldest = past_.data() + (end_ - samples_);
    for (std::size_t i = 0; i < samples_; ++i) {
        window[i] = oldest[i] + slope * static_cast<double>(samples_ - 1 - i);
    }
    return denoised(window);
}

double WaveletDenoiser::denoised(std::span<const double> window) {
    const int levels = std::min(options_.levels, levels_of(window.size()));
    std::span<const double> signal = window;
    for (int i = 0; i < levels; ++i) {
        Level& level = levels_[static_cast<std::size_t>(i)];
        level.size = coefficients_of(signal.size());
        analyse_level(signal, std::span(level.approximation).first(level.size),
                      std::span(level.detail).first(level.size));
        signal = std::span<const double>(level.approximation).first(level.size);
    }
    shrink_needed(levels, window.size());
    // From the coarsest up: only what the last sample rests on.
    std::array<std::size_t, 32> first{};
    first[0] = window.size() - 1;
    for (int i = 1; i <= levels; ++i) {
        first.at(static_cast<std::size_t>(i)) = first_coefficient(first.at(static_cast<std::size_t>(i - 1)));
    }
    for (int i = levels; i-- > 0;) {
        const auto at = static_cast<std::size_t>(i);
        Level& level = levels_[at];
        const std::size_t size = i == 0 ? window.size() : levels_[at - 1].size;
        const std::span<double> samples = std::span(restored_).first(size - first.at(at));
        restore_level(std::span<const double>(level.approximation).first(level.size),
                      std::span<const double>(level.detail).first(level.size), first.at(at), samples);
        if (i == 0) { return samples.front(); }
        std::ranges::copy(samples,
                          levels_[at - 1].approximation.begin() + static_cast<std::ptrdiff_t>(first.at(at)));
    }
    return window.back();
}

// Only details that the last sample rests on are worth the trouble.
void WaveletDenoiser::shrink_needed(int levels, std::size_t samples) {
    const double factor = std::sqrt(2.0 * std::log(static_cast<double>(samples)));
    std::size_t first = samples - 1;
    double sigma = 0.0;
    for (int i = 0; i < levels; ++i) {
        Level& level = levels_[static_cast<std::size_t>(i)];
        first = first_coefficient(first);
        if (i == 0 || options_.noise == NoiseLevel::each) { sigma = noise_of(i); }
        for (std::size_t k = first; k < level.size; ++k) {
            if (std::abs(level.detail[k]) <= sigma * factor) { level.detail[k] = 0.0; }
        }
    }
}

double WaveletDenoiser::noise_of(int index) {
    const Level& level = levels_[static_cast<std::size_t>(index)];
    const std::span<double> sizes = std::span(sizes_).first(level.size);
    std::transform(level.detail.begin(), level.detail.begin() + static_cast<std::ptrdiff_t>(level.size),
                   sizes.begin(), [](double x) { return std::abs(x); });
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    double median = *middle;
    if (sizes.size() % 2 == 0) { median = 0.5 * (median + *std::max_element(sizes.begin(), middle)); }
    return median / median_of_normal_sizes;
}

std::vector<double> WaveletDenoiser::smoothing_weights(const WaveletOptions& options) {
    const std::size_t window = std::max(options.window, least_window);
    const int levels = std::min(options.levels, levels_of(window));
    std::vector<double> weights(window);
    for (std::size_t age = 0; age < window; ++age) {
        std::vector<std::size_t> sizes{window};
        std::vector<double> signal(window, 0.0);
        signal[window - 1 - age] = 1.0;
        for (int i = 0; i < levels; ++i) {
            std::vector<double> approximation(coefficients_of(signal.size()));
            std::vector<double> detail(approximation.size());
            analyse_level(signal, approximation, detail);
            signal = std::move(approximation);
            sizes.push_back(signal.size());
        }
        for (int i = levels; i-- > 0;) {
            std::vector<double> finer(sizes[static_cast<std::size_t>(i)]);
            restore_level(signal, std::vector<double>(signal.size(), 0.0), 0, finer);
            signal = std::move(finer);
        }
        weights[age] = signal.back();
    }
    return weights;
}

}  // namespace gyrolog
