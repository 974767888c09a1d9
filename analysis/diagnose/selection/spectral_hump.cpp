#include "analysis/diagnose/selection/spectral_hump.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <span>
#include <string_view>

#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "analysis/simulate/effect.hpp"

namespace gyrolog {

namespace {

constexpr EffectParam params[] = {
    {.name = "density_dps_rthz",
     .meaning = "square root of twice the two-sided density at f_hz",
     .range = EffectParam::Range::positive,
     .plausible_from = 0.0005,
     .plausible_to = 0.5},
    {.name = "f_hz",
     .meaning = "where one slope meets the other",
     .range = EffectParam::Range::positive,
     .plausible_from = 0.001,
     .plausible_to = 50.0},
    {.name = "rise",
     .meaning = "exponent of the density below f_hz",
     .range = EffectParam::Range::positive,
     .plausible_from = 0.5,
     .plausible_to = 16.0},
    {.name = "fall",
     .meaning = "exponent above f_hz, sign aside",
     .range = EffectParam::Range::positive,
     .plausible_from = 1.0,
     .plausible_to = 16.0},
};

void spectrum(std::span<const double> f_hz, double /*rate_hz*/, const EffectValues& effect,
              std::span<SpectralParts> parts) {
    const double density_rad_rthz = effect["density_dps_rthz"] * rad_per_deg;
    const double log_middle = std::log(effect["f_hz"]);
    const double rise = effect["rise"];
    const double fall = effect["fall"];
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double log_x = std::log(f_hz[i]) - log_middle;
        parts[i].other +=
            density_rad_rthz * density_rad_rthz / (std::exp(-rise * log_x) + std::exp(fall * log_x));
    }
}

constexpr std::string_view fitted[] = {"density_dps_rthz", "f_hz", "rise", "fall"};
constexpr TrialValues shapes[] = {{.param = "f_hz", .from = 0.001, .to = 50.0, .count = 20},
                                  {.param = "rise", .from = 1.0, .to = 8.0, .count = 2},
                                  {.param = "fall", .from = 2.0, .to = 8.0, .count = 2}};
constexpr std::span<const TrialValues> trials[] = {shapes};

constexpr EffectSignature signature = {
    .trials = trials,
    .spectral = fitted,
    .spectrum = spectrum,
};

// Of no model: it has a spectrum to be fitted, and nothing that would simulate it.
constinit const EffectDefinition hump = {
    .name = "spectral_hump",
    .model = "density_dps_rthz^2 x^rise / (1 + x^(rise + fall)), x = f / f_hz",
    .source = "",
    .params = params,
    .make = nullptr,
    .noise_only = true,
    .signature = &signature,
};

}  // namespace

std::optional<NonparametricFit> find_spectral_hump(const Observation& without, const Observation& /*with*/) {
    const std::shared_ptr<const Prediction> not_owned(&without.prediction(), [](const Prediction*) {});
    const std::optional<Finding> finding =
        make_noise_spectrum_estimator(hump, not_owned).estimator->find(without);
    if (!finding) { return std::nullopt; }
    const std::map<std::string, double>& at = finding->entries.front().params;
    std::array<char, 160> words{};
    (void)std::snprintf(words.data(), words.size(),
                        "Noise about %.3g Hz whose density rises as f^%.2g and falls as f^-%.2g",
                        at.at("f_hz"), at.at("rise"), at.at("fall"));
    return NonparametricFit{words.data(), finding->evidence_nats};
}

}  // namespace gyrolog
