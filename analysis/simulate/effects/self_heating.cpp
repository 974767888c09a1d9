#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/settling.hpp"

namespace gyrolog {

namespace {

class SelfHeating final : public Stage {
public:
    SelfHeating(double rise_C, const Settling& settling) : rise_C_(rise_C), settling_(settling) {}

    void apply(SampleBlock& block) override {
        if (block.begin == 0) { left_ = settling_.left_at(block.first_index); }
        for (double& die_C : block.slots(block.die_C)) {
            die_C += rise_C_ * (1.0 - left_);
            left_ *= settling_.left_after_one();
        }
    }

private:
    double rise_C_;
    Settling settling_;
    double left_ = 1.0;
};

std::unique_ptr<Stage> make_self_heating(const EffectUse& use) {
    return std::make_unique<SelfHeating>(use["rise_C"], Settling(use["tau_s"] * use.context().rate_hz));
}

constexpr EffectParam self_heating_params[] = {
    {.name = "rise_C", .meaning = "in the end", .plausible_from = 0.0, .plausible_to = 15.0},
    {.name = "tau_s",
     .meaning = "time constant",
     .range = EffectParam::Range::positive,
     .plausible_from = 60.0,
     .plausible_to = 900.0},
};

}  // namespace

constinit const EffectDefinition self_heating_effect = {
    .name = "self_heating",
    .model = "T + rise_C (1 - exp(-t / tau_s)), of the whole die, whatever the axes",
    .source = "",
    .params = self_heating_params,
    .make = make_self_heating,
    .warms = true,
};

}  // namespace gyrolog
