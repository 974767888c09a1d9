#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/white_noise_gain.hpp"

namespace gyrolog {

namespace {

struct Change {
    double factor;
    double at_samples;
    double ramp_samples;

    double operator()(const SampleBlock& block, std::size_t i) const {
        return after(static_cast<double>(block.first_index + i));
    }

    double after(double samples) const {
        const double since = samples - at_samples;
        if (since < 0.0) { return 1.0; }
        const double share = since < ramp_samples ? since / ramp_samples : 1.0;
        return 1.0 + (factor - 1.0) * share;
    }
};

Change change_of(const EffectUse& use) {
    const double rate_hz = use.context().rate_hz;
    return {use["factor"], use["at_s"] * rate_hz, use["ramp_s"] * rate_hz};
}

std::unique_ptr<Stage> make_variance_change(const EffectUse& use) {
    return std::make_unique<WhiteNoiseGain<Change>>(use, change_of(use));
}

WhiteGain variance_change_white_gain(const EffectUse& use) {
    return [change = change_of(use), rate_hz = use.context().rate_hz](double time_s, double) {
        return change.after(time_s * rate_hz);
    };
}

constexpr EffectParam variance_change_params[] = {
    {.name = "factor",
     .meaning = "of the standard deviation, in the end",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.5,
     .plausible_to = 4.0},
    {.name = "at_s", .meaning = "when the change begins", .plausible_from = 0.0, .plausible_to = 1e5},
    {.name = "ramp_s",
     .meaning = "how long it takes, in a straight line",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.0,
     .plausible_to = 1e5,
     .otherwise = 0.0},
};

constexpr EffectSignature variance_change_signature = {
    .method = EvidenceMethod::variance_change_point,
    .place = PlaceKind::time,
    .event = true,
    .white_gain = variance_change_white_gain,
    .words =
        "From {at_s} after the start on the white noise changes within {ramp_s} to {factor} times its "
        "standard deviation.",
    .noun = "a change of the white noise to {factor} times its standard deviation",
    .decided_by = "a second recording, with the same temperatures at other times",
};

}  // namespace

constinit const EffectDefinition variance_change_effect = {
    .name = "variance_change",
    .model = "white noise times 1 before at_s, factor from at_s + ramp_s on, straight between",
    .source = "",
    .params = variance_change_params,
    .make = make_variance_change,
    .signature = &variance_change_signature,
};

}  // namespace gyrolog
