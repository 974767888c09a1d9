#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class ClockRate final : public Stage {
public:
    explicit ClockRate(const EffectUse& use)
        : stretch_(1.0 / (1.0 + use["rel"]) - 1.0),
          period_s_(1.0 / use.context().rate_hz),
          model_latency_s_(use.context().model.latency_s),
          in_stamps_(use["in_stamps"] != 0.0) {}

    void apply(SampleBlock& block) override {
        for (std::size_t i = 0; i < block_samples; ++i) {
            block.world_s[i] += stretch_ * (block.world_s[i] + model_latency_s_);
            if (in_stamps_) {
                block.stamp_s[i] += stretch_ * period_s_ * static_cast<double>(block.first_index + i);
            }
        }
    }

private:
    double stretch_;
    double period_s_;
    double model_latency_s_;
    bool in_stamps_;
};

std::unique_ptr<Stage> make(const EffectUse& use) { return std::make_unique<ClockRate>(use); }

constexpr EffectParam params[] = {
    {.name = "rel",
     .meaning = "relative error of the sample rate; positive: samples come too fast",
     .plausible_from = -0.01,
     .plausible_to = 0.01},
    {.name = "in_stamps",
     .meaning = "1: the time stamps are true and show it; 0: they are nominal, and the world runs away from "
                "them",
     .range = EffectParam::Range::yes_no,
     .plausible_from = 0.0,
     .plausible_to = 1.0,
     .otherwise = 1.0},
};

}  // namespace

constinit const EffectDefinition clock_rate_effect = {
    .name = "clock_rate",
    .model = "sample k is taken at k / (rate (1 + rel)); the sensor as a whole, whatever its axes",
    .source = "",
    .params = params,
    .make = make,
};

}  // namespace gyrolog
