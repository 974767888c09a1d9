#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class ClockJitter final : public Stage {
public:
    explicit ClockJitter(const EffectUse& use)
        : stream_(use.stream(0)), sd_s_(use["sd_s"]), in_stamps_(use["in_stamps"] != 0.0) {}

    void apply(SampleBlock& block) override {
        BlockValues draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        stream_.normals(block.first(), block.slots(draws));
        BlockValues& jittered_s = in_stamps_ ? block.stamp_s : block.world_s;
        for (std::size_t i = block.begin; i < block.end; ++i) { jittered_s[i] += sd_s_ * draws[i]; }
    }

private:
    RandomStream stream_;
    double sd_s_;
    bool in_stamps_;
};

std::unique_ptr<Stage> make_clock_jitter(const EffectUse& use) { return std::make_unique<ClockJitter>(use); }

constexpr EffectParam clock_jitter_params[] = {
    {.name = "sd_s",
     .meaning = "standard deviation of one instant, independent of the others",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 2e-5,
     .plausible_to = 3e-3},
    {.name = "in_stamps",
     .meaning = "1: the stamps scatter about regular samples; 0: the samples scatter about regular stamps",
     .range = EffectParam::Range::yes_no,
     .plausible_from = 0.0,
     .plausible_to = 1.0,
     .otherwise = 1.0},
};

constexpr EffectSignature clock_jitter_signature = {
    .method = EvidenceMethod::stamp_jitter,
    .place = PlaceKind::structure,
    .structure = "timestamp_jitter",
    .instant_sd_s =
        [](const EffectValues& effect) { return effect["in_stamps"] == 0.0 ? effect["sd_s"] : 0.0; },
    .words = "Single sampling times are off by {sd_s} (one sigma) beyond what the model says.",
    .noun = "a jitter of the sampling times of {sd_s}",
    .decided_by = "stamps taken in the board's interrupt, or broadband motion under a reference rate",
};

}  // namespace

constinit const EffectDefinition clock_jitter_effect = {
    .name = "clock_jitter",
    .model = "t_k + sd_s times an independent standard normal draw; the sensor as a whole, whatever its axes",
    .source = "",
    .params = clock_jitter_params,
    .make = make_clock_jitter,
    .noise_only = true,
    .signature = &clock_jitter_signature,
};

}  // namespace gyrolog
