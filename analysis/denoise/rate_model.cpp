#include "analysis/denoise/rate_model.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {
namespace {

constexpr std::array<std::pair<RateModel, std::string_view>, 4> rate_model_names{
    {{RateModel::free, "free"},
     {RateModel::walk, "walk"},
     {RateModel::trend, "trend"},
     {RateModel::adaptive, "adaptive"}}};

double walk_intensity(double radians_per_sample) {
    const double k = 1.0 - std::cos(radians_per_sample);
    const double gain = -k + std::sqrt(k * k + 2.0 * k);
    return gain * gain / (1.0 - gain);
}

double trend_power(double index, double radians_per_sample) {
    const double q = (4.0 + index - std::sqrt(8.0 * index + index * index)) / 4.0;
    const double alpha = 1.0 - q * q;
    const double beta = 2.0 * (2.0 - alpha) - 4.0 * std::sqrt(1.0 - alpha);
    const std::complex<double> back = std::polar(1.0, -radians_per_sample);
    return std::norm((alpha + (beta - alpha) * back) /
                     (1.0 - (2.0 - alpha - beta) * back + (1.0 - alpha) * back * back));
}

// The power passed at a frequency rises with the index.
double trend_intensity(double radians_per_sample) {
    double lo = 1e-12;
    double hi = 1e6;
    constexpr int halvings = 200;
    for (int i = 0; i < halvings; ++i) {
        const double index = std::sqrt(lo * hi);
        (trend_power(index, radians_per_sample) < 0.5 ? lo : hi) = index;
    }
    return lo * lo;
}

}  // namespace

std::string_view name_of(RateModel model) {
    for (const auto& [value, name] : rate_model_names) {
        if (value == model) { return name; }
    }
    return "";
}

std::optional<RateModel> rate_model(std::string_view name) {
    for (const auto& [value, known] : rate_model_names) {
        if (known == name) { return value; }
    }
    return std::nullopt;
}

double intensity_of(const RateDesign& design, double rate_hz) {
    const double radians_per_sample = 2.0 * pi * design.bandwidth_hz / rate_hz;
    switch (design.model) {
        case RateModel::walk:
            return walk_intensity(radians_per_sample);
        case RateModel::trend:
            return trend_intensity(radians_per_sample);
        case RateModel::adaptive:
        case RateModel::free:
            break;
    }
    return 0.0;
}

}  // namespace gyrolog
