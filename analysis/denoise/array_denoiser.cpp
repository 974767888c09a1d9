#include "analysis/denoise/array_denoiser.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gyrolog {
namespace {

constexpr std::array<std::pair<DenoiseMethod, std::string_view>, 3> method_names{
    {{DenoiseMethod::kalman, "kalman"},
     {DenoiseMethod::wavelet, "wavelet"},
     {DenoiseMethod::joint, "joint"}}};

constexpr double default_share_of_rate = 0.25;
constexpr double sure_slope = 3.3;
// Offsets of a varying gain are then known to an eighth of a sample's noise.
constexpr std::size_t samples_for_offsets = 64;

RateDesign filter_design(const DenoiseDesign& design) {
    return design.method == DenoiseMethod::wavelet ? RateDesign{} : design.rate;
}

}  // namespace

std::string_view name_of(DenoiseMethod method) {
    for (const auto& [value, name] : method_names) {
        if (value == method) { return name; }
    }
    return "";
}

std::optional<DenoiseMethod> denoise_method(std::string_view name) {
    for (const auto& [value, known] : method_names) {
        if (known == name) { return value; }
    }
    return std::nullopt;
}

RateDesign default_rate_design(DenoiseMethod method, double rate_hz) {
    if (method != DenoiseMethod::joint) { return {}; }
    return {RateModel::adaptive, default_share_of_rate * rate_hz};
}

WaveletOptions wavelet_options(const DenoiseDesign& design) {
    const bool white = filter_design(design).model == RateModel::free;
    return {design.window, design.levels, white ? NoiseLevel::finest : NoiseLevel::each};
}

ArrayDenoiser::ArrayDenoiser(const ArrayNoise& noise, std::span<const UnitLimits> limits,
                             const DenoiseDesign& design, std::span<const double> offsets)
    : design_(design),
      filter_(noise, filter_design(design), design.gain, offsets),
      watch_(limits),
      wavelet_(wavelet_options(design)) {
    const RateDesign rate = filter_design(design);
    if (rate.model == RateModel::adaptive) {
        const double sd = filter_.settled_rate_sd();
        adaptive_.emplace(rate.bandwidth_hz, noise.rate_hz, sd * sd);
    }
}

double ArrayDenoiser::step(std::span<const double> rates) {
    const std::size_t units = rates.size();
    for (std::size_t i = 0; i < units; ++i) { offsets_.at(i) = filter_.offset(i); }
    const bool offsets_known = ++since_gap_ > samples_for_offsets;
    states_ = watch_.judge(rates, std::span(offsets_).first(units), offsets_known);
    bool any = false;
    for (std::size_t i = 0; i < units; ++i) {
        const bool usable = design_.watch ? states_[i] == UnitState::good : states_[i] != UnitState::missing;
        used_.at(i) = usable ? 1 : 0;
        any = any || usable;
    }
    // Where no unit is good, a bad one still says more than none.
    if (!any) {
        for (std::size_t i = 0; i < units; ++i) { used_.at(i) = states_[i] != UnitState::missing ? 1 : 0; }
    }
    double rate = filter_.step(rates, std::span(used_).first(units));
    if (adaptive_) { rate = adaptive_->step(rate, filter_.rate_sd() * filter_.rate_sd()); }
    if (design_.method == DenoiseMethod::kalman) { return rate; }
    if (adaptive_) {
        // Motion that the narrowest model does not follow would be bent at the window's end.
        const double calm = adaptive_->probabilities().front();
        return calm * wavelet_.step(rate, adaptive_->slope()) + (1.0 - calm) * rate;
    }
    const double slope = filter_.slope();
    return wavelet_.step(rate, std::abs(slope) > sure_slope * filter_.slope_sd() ? slope : 0.0);
}

void ArrayDenoiser::skip(std::size_t samples) {
    filter_.skip(samples);
    if (adaptive_) { adaptive_->reset(); }
    wavelet_.reset();
}

}  // namespace gyrolog
