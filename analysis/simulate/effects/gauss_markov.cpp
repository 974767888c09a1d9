#include <algorithm>
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

}  // namespace

std::unique_ptr<Stage> make_gauss_markov_effect(const StageContext& context, const EffectModel& effect) {
    // Several of them on one axis are independent of each other.
    const auto& all = context.model.effects;
    const auto part = static_cast<unsigned>(
        std::ranges::find_if(all, [&](const EffectModel& other) { return &other == &effect; }) - all.begin());
    return PerAxis<GaussMarkovNoise>::make([&](std::size_t axis) -> std::optional<GaussMarkovNoise> {
        if (!acts_on(effect, axis)) { return std::nullopt; }
        const double correlation = portable_exp(-1.0 / (context.rate_hz * effect.params.at("tau_s")));
        return GaussMarkovNoise{context.stream({'G', 'M'}, axis, part),
                                effect.params.at("sigma_dps") * rad_per_deg, correlation};
    });
}

}  // namespace gyrolog
