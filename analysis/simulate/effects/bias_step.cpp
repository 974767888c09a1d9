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

std::unique_ptr<Stage> make_bias_step(const EffectUse& use) {
    return PerAxis<BiasStep>::make([&](std::size_t axis) -> std::optional<BiasStep> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return BiasStep{use["step_dps"] * rad_per_deg, use["at_s"] * use.context().rate_hz};
    });
}

constexpr EffectParam bias_step_params[] = {
    {.name = "step_dps", .meaning = "change of the bias", .plausible_from = -0.5, .plausible_to = 0.5},
    {.name = "at_s", .meaning = "from this time on", .plausible_from = 0.0, .plausible_to = 1e5},
};

constexpr EffectSignature bias_step_signature = {
    .method = EvidenceMethod::step,
    .place = PlaceKind::instant,
    .event = true,
    .words = "The output jumps once, {at_s} after the first sample, by {step_dps}.",
    .noun = "a jump by {step_dps}",
    .decided_by =
        "a second recording of the same length at rest: a jump that was one event is not in it, "
        "noise that wanders is",
};

}  // namespace

constinit const EffectDefinition bias_step_effect = {
    .name = "bias_step",
    .model = "rate + step_dps for t >= at_s",
    .source = "",
    .params = bias_step_params,
    .make = make_bias_step,
    .signature = &bias_step_signature,
};

}  // namespace gyrolog
