#include <algorithm>
#include <cmath>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/portable_math.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

namespace {

struct Tone {
    double amplitude_rad_s;
    double turns_per_sample;
    double phase_turns;

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) const {
        for (std::size_t i = 0; i < rate_rad_s.size(); ++i) {
            const double turns = turns_per_sample * static_cast<double>(first_index + i) + phase_turns;
            rate_rad_s[i] += amplitude_rad_s * portable_sine_of_turns(turns);
        }
    }
};

std::unique_ptr<Stage> make(const EffectUse& use) {
    return PerAxis<Tone>::make([&](std::size_t axis) -> std::optional<Tone> {
        if (!use.acts_on(axis)) { return std::nullopt; }
        return Tone{use["amplitude_dps"] * rad_per_deg, use["f_hz"] / use.context().rate_hz,
                    use["phase_rad"] / (2.0 * pi)};
    });
}

constexpr EffectParam params[] = {
    {.name = "f_hz",
     .meaning = "frequency; above half the rate the line appears folded",
     .range = EffectParam::Range::positive,
     .plausible_from = 3.0,
     .plausible_to = 200.0},
    {.name = "amplitude_dps", .meaning = "amplitude", .plausible_from = 0.001, .plausible_to = 0.5},
    {.name = "phase_rad",
     .meaning = "phase at the first sample",
     .plausible_from = -pi,
     .plausible_to = pi,
     .otherwise = 0.0},
};

}  // namespace

constinit const EffectDefinition tone_effect = {
    .name = "tone",
    .model = "rate + amplitude_dps sin(2 pi f_hz t + phase_rad)",
    .source = "IEEE 952-1997, C.1.6 (sinusoidal noise)",
    .params = params,
    .make = make,
};

}  // namespace gyrolog
