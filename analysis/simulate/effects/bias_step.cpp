#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

namespace {

struct BiasStep {
    double step_rad_s;
    double at_samples;

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) const {
        for (std::size_t i = 0; i < rate_rad_s.size(); ++i) {
            if (static_cast<double>(first_index + i) >= at_samples) { rate_rad_s[i] += step_rad_s; }
        }
    }
};

}  // namespace

std::unique_ptr<Stage> make_bias_step_effect(const StageContext& context, const EffectModel& effect) {
    return PerAxis<BiasStep>::make([&](std::size_t axis) -> std::optional<BiasStep> {
        if (!acts_on(effect, axis)) { return std::nullopt; }
        return BiasStep{effect.params.at("step_dps") * rad_per_deg,
                        effect.params.at("at_s") * context.rate_hz};
    });
}

}  // namespace gyrolog
