#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class Latency final : public Stage {
public:
    explicit Latency(double delay_s) : delay_s_(delay_s) {}

    void apply(SampleBlock& block) override {
        for (double& world_s : block.slots(block.world_s)) { world_s -= delay_s_; }
    }

private:
    double delay_s_;
};

std::unique_ptr<Stage> make_latency(const EffectUse& use) {
    return std::make_unique<Latency>(use["delay_s"]);
}

constexpr EffectParam latency_params[] = {
    {.name = "delay_s",
     .meaning = "age of what a sample shows at its time stamp, beyond the model's latency_s",
     .plausible_from = 5e-4,
     .plausible_to = 1e-2},
};

constexpr TrialValues delay_values[] = {{.param = "delay_s", .from = 3e-4, .to = 1.5e-2, .count = 12}};
constexpr std::span<const TrialValues> latency_trials[] = {delay_values};

constexpr EffectSignature latency_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::rate,
    .needs_reference = true,
    .needs_change = true,
    .whole_sensor = true,
    .trials = latency_trials,
    .words = "The sensor is {delay_s} late",
    .noun = "a delay of {delay_s}",
    .decided_by = "broadband motion, up to a tenth of the sample rate",
};

}  // namespace

constinit const EffectDefinition latency_effect = {
    .name = "latency",
    .model = "the sample stamped t shows the world of t - delay_s; the sensor as a whole, whatever its axes",
    .source = "",
    .params = latency_params,
    .make = make_latency,
    .timing_only = true,
    .signature = &latency_signature,
};

}  // namespace gyrolog
