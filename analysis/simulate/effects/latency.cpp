#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class Latency final : public Stage {
public:
    explicit Latency(double delay_s) : delay_s_(delay_s) {}

    void apply(SampleBlock& block) override {
        for (double& world_s : block.world_s) { world_s -= delay_s_; }
    }

private:
    double delay_s_;
};

std::unique_ptr<Stage> make(const EffectUse& use) { return std::make_unique<Latency>(use["delay_s"]); }

constexpr EffectParam params[] = {
    {.name = "delay_s",
     .meaning = "age of what a sample shows at its time stamp, beyond the model's latency_s",
     .plausible_from = 5e-4,
     .plausible_to = 1e-2},
};

}  // namespace

constinit const EffectDefinition latency_effect = {
    .name = "latency",
    .model = "the sample stamped t shows the world of t - delay_s; the sensor as a whole, whatever its axes",
    .source = "",
    .params = params,
    .make = make,
};

}  // namespace gyrolog
