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

std::unique_ptr<Stage> make(const EffectUse& use) {
    return PerAxis<GaussMarkovNoise>::make([&](std::size_t axis) -> std::optional<GaussMarkovNoise> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        const double correlation = portable_exp(-1.0 / (use.context().rate_hz * use["tau_s"]));
        return GaussMarkovNoise{use.stream(axis), use["sigma_dps"] * rad_per_deg, correlation};
    });
}

constexpr EffectParam params[] = {
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

}  // namespace

constinit const EffectDefinition gauss_markov_effect = {
    .name = "gauss_markov",
    .model = "stationary Gaussian, covariance sigma_dps^2 exp(-|t|/tau_s), independent on each axis",
    .source = "IEEE 952-1997, C.1.5",
    .params = params,
    .make = make,
    .noise_only = true,
};

}  // namespace gyrolog
