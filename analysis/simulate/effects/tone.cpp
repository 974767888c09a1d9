#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"

namespace gyrolog {

namespace {

// Vibration and mains come from outside: a sample shows them as of the moment of the world that it shows.
class Tone final : public Stage {
public:
    explicit Tone(const EffectUse& use) : f_hz_(use["f_hz"]), phase_turns_(use["phase_rad"] / (2.0 * pi)) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (use.acts_on(axis)) { amplitude_rad_s_[axis] = use["amplitude_dps"] * rad_per_deg; }
        }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const double sine = portable_sine_of_turns(f_hz_ * block.world_s[i] + phase_turns_);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.rate_rad_s[axis][i] += amplitude_rad_s_[axis] * sine;
            }
        }
    }

private:
    double f_hz_;
    double phase_turns_;
    Vector3 amplitude_rad_s_{};
};

std::unique_ptr<Stage> make_tone(const EffectUse& use) { return std::make_unique<Tone>(use); }

constexpr EffectParam tone_params[] = {
    {.name = "f_hz",
     .meaning = "frequency; above half the rate the line appears folded",
     .range = EffectParam::Range::positive,
     .plausible_from = 3.0,
     .plausible_to = 200.0},
    {.name = "amplitude_dps",
     .meaning = "amplitude, as the samples show it",
     .plausible_from = 0.001,
     .plausible_to = 0.5},
    {.name = "phase_rad",
     .meaning = "phase when the nominal first sample is taken",
     .plausible_from = -pi,
     .plausible_to = pi,
     .otherwise = 0.0},
};

constexpr EffectSignature tone_signature = {
    .method = EvidenceMethod::line,
    .place = PlaceKind::spectrum,
    .words =
        "A steady line stands at {f_hz}, {amplitude_dps} high; one above half the sampling rate that folds "
        "to there would look the same.",
    .noun = "a line at {f_hz}",
    .decided_by =
        "a recording at another sampling rate, which shows whether the line is folded and from where",
};

}  // namespace

constinit const EffectDefinition tone_effect = {
    .name = "tone",
    .model = "rate + amplitude_dps sin(2 pi f_hz t + phase_rad), t the moment that the sample shows",
    .source = "IEEE 952-1997, C.1.6 (sinusoidal noise)",
    .params = tone_params,
    .make = make_tone,
    .signature = &tone_signature,
};

}  // namespace gyrolog
