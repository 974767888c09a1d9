#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

namespace {

struct GaussMarkovNoise {
    RandomStream stream;
    double sigma_rad_s;
    double correlation;  // from one sample to the next
    double state = 0.0;  // in units of sigma

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        std::array<double, block_samples> draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        const std::span<double> used = std::span(draws).first(rate_rad_s.size());
        stream.normals(first_index, used);
        const double innovation = std::sqrt(1.0 - correlation * correlation);
        for (std::size_t i = 0; i < used.size(); ++i) {
            state = first_index + i == 0 ? used[i] : correlation * state + innovation * used[i];
            rate_rad_s[i] += sigma_rad_s * state;
        }
    }
};

std::unique_ptr<Stage> make_gauss_markov(const EffectUse& use) {
    return PerAxis<GaussMarkovNoise>::make([&](std::size_t axis) -> std::optional<GaussMarkovNoise> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        const double correlation = portable_exp(-1.0 / (use.context().rate_hz * use["tau_s"]));
        return GaussMarkovNoise{use.stream(axis), use["sigma_dps"] * rad_per_deg, correlation};
    });
}

constexpr EffectParam gauss_markov_params[] = {
    {.name = "sigma_dps",
     .meaning = "standard deviation",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.001,
     .plausible_to = 0.05},
    {.name = "tau_s",
     .meaning = "correlation time",
     .range = EffectParam::Range::positive,
     .plausible_from = 0.2,
     .plausible_to = 500.0},
};

void gauss_markov_spectrum(std::span<const double> f_hz, double rate_hz, const EffectValues& effect,
                           std::span<SpectralParts> parts) {
    const double sigma_rad_s = effect["sigma_dps"] * rad_per_deg;
    const double correlation = std::exp(-1.0 / (rate_hz * effect["tau_s"]));
    // Of the sampled process, a first-order autoregression.
    const double innovation = sigma_rad_s * sigma_rad_s * (1.0 - correlation * correlation) / rate_hz;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double cosine = std::cos(2.0 * pi * f_hz[i] / rate_hz);
        parts[i].added_signal += innovation / (1.0 - 2.0 * correlation * cosine + correlation * correlation);
    }
}

constexpr std::string_view gauss_markov_fitted[] = {"sigma_dps", "tau_s"};
constexpr TrialValues gauss_markov_tau_values[] = {{.param = "tau_s", .from = 0.2, .to = 500.0, .count = 14}};
constexpr std::span<const TrialValues> gauss_markov_trials[] = {gauss_markov_tau_values};

constexpr EffectSignature gauss_markov_signature = {
    .trials = gauss_markov_trials,
    .spectral = gauss_markov_fitted,
    .spectrum = gauss_markov_spectrum,
    .words = "The output fluctuates by {sigma_dps} with a correlation time of {tau_s}",
    .noun = "a Gauss-Markov process of {sigma_dps} with a correlation time of {tau_s}",
    .decided_by = "a still recording of 50 correlation times or more",
};

}  // namespace

constinit const EffectDefinition gauss_markov_effect = {
    .name = "gauss_markov",
    .model = "stationary Gaussian, covariance sigma_dps^2 exp(-|t|/tau_s), independent on each axis",
    .source = "IEEE 952-1997, C.1.5",
    .params = gauss_markov_params,
    .make = make_gauss_markov,
    .noise_only = true,
    .signature = &gauss_markov_signature,
};

}  // namespace gyrolog
