#include "analysis/recording/recording.hpp"
#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

// The chain runs at the true rate already (EffectDefinition::rate_error); what is left are stamps that do not
// know of it.
class NominalStamps final : public Stage {
public:
    NominalStamps(double rel, double period_s) : late_per_sample_s_(rel * period_s) {}

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            block.stamp_s[i] += late_per_sample_s_ * static_cast<double>(block.first_index + i);
        }
    }

private:
    double late_per_sample_s_;
};

std::unique_ptr<Stage> make_clock_rate(const EffectUse& use) {
    if (use["in_stamps"] != 0.0) { return nullptr; }
    return std::make_unique<NominalStamps>(use["rel"], 1.0 / use.context().rate_hz);
}

constexpr EffectParam clock_rate_params[] = {
    {.name = "rel",
     .meaning = "relative error of the sample rate; positive: samples come too fast",
     .plausible_from = -0.01,
     .plausible_to = 0.01,
     .most = 0.5},
    {.name = "in_stamps",
     .meaning = "1: the time stamps are true and show it; 0: they are nominal, and the world runs away from "
                "them",
     .range = EffectParam::Range::yes_no,
     .plausible_from = 0.0,
     .plausible_to = 1.0,
     .otherwise = 1.0},
};

// A sensor that is slow for its stamps shows at the end what came after the last of them.
void leave_out_the_future(const Recording& recording, const EffectModel& entry, std::vector<bool>& judged) {
    const EffectValues values(entry);
    if (values["in_stamps"] != 0.0 || values["rel"] >= 0.0 || recording.segments.empty()) { return; }
    const std::int64_t origin = recording.segments.front().first_index;
    const Segment& last = recording.segments.back();
    const auto end = static_cast<double>(last.first_index - origin) + static_cast<double>(last.count) - 1.0;
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const double slot = static_cast<double>(segment.first_index - origin) + static_cast<double>(i);
            if (slot > end * (1.0 + values["rel"])) { judged[segment.first + i] = false; }
        }
    }
}

constexpr EffectSignature clock_rate_signature = {
    .method = EvidenceMethod::stamp_rate,
    .place = PlaceKind::structure,
    .structure = "timestamp_rate",
    .unjudged = leave_out_the_future,
    .words = "The sample clock is off by {rel} of its nominal rate.",
    .noun = "an error of the sample clock of {rel}",
    .decided_by = "an hour of stamps from a disciplined clock, or a reference rate that never rests",
};

}  // namespace

constinit const EffectDefinition clock_rate_effect = {
    .name = "clock_rate",
    .model = "sample k is taken at k / (rate (1 + rel)); the sensor as a whole, whatever its axes",
    .source = "",
    .params = clock_rate_params,
    .make = make_clock_rate,
    .rate_error = "rel",
    .timing_only = true,
    .signature = &clock_rate_signature,
};

}  // namespace gyrolog
