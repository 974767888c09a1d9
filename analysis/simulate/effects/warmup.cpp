#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/settling.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

namespace {

struct Warmup {
    double a_rad_s;
    Settling settling;
    double left_rad_s = 0.0;

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        if (first_index % block_samples == 0) { left_rad_s = a_rad_s * settling.left_at(first_index); }
        for (double& rate : rate_rad_s) {
            rate += left_rad_s;
            left_rad_s *= settling.left_after_one();
        }
    }
};

std::unique_ptr<Stage> make_warmup(const EffectUse& use) {
    const Settling settling(use["tau_s"] * use.context().rate_hz);
    return PerAxis<Warmup>::make([&](std::size_t axis) -> std::optional<Warmup> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return Warmup{use["a_dps"] * rad_per_deg, settling};
    });
}

constexpr EffectParam warmup_params[] = {
    {.name = "a_dps", .meaning = "away from the bias at first", .plausible_from = -3.0, .plausible_to = 3.0},
    {.name = "tau_s",
     .meaning = "time constant",
     .range = EffectParam::Range::positive,
     .plausible_from = 60.0,
     .plausible_to = 900.0},
};

constexpr std::string_view warmup_linear[] = {"a_dps"};
constexpr TrialValues warmup_tau_values[] = {{.param = "tau_s", .from = 45.0, .to = 1200.0, .count = 12}};
constexpr std::span<const TrialValues> warmup_trials[] = {warmup_tau_values};

constexpr EffectSignature warmup_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::time,
    .linear = warmup_linear,
    .event = true,
    .slow = true,
    .trials = warmup_trials,
    .words = "The output settles: {a_dps} at first, with a time constant of {tau_s}",
    .noun = "a settling of {a_dps} with a time constant of {tau_s}",
    .decided_by = "two or three cold starts of half an hour",
};

}  // namespace

constinit const EffectDefinition warmup_effect = {
    .name = "warmup",
    .model = "rate + a_dps exp(-t / tau_s)",
    .source = "",
    .params = warmup_params,
    .make = make_warmup,
    .signature = &warmup_signature,
};

}  // namespace gyrolog
