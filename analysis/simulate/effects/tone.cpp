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

}  // namespace

std::unique_ptr<Stage> make_tone_effect(const StageContext& context, const EffectModel& effect) {
    return PerAxis<Tone>::make([&](std::size_t axis) -> std::optional<Tone> {
        if (!acts_on(effect, axis)) { return std::nullopt; }
        return Tone{effect.params.at("amplitude_dps") * rad_per_deg,
                    effect.params.at("f_hz") / context.rate_hz, effect.params.at("phase_rad") / (2.0 * pi)};
    });
}

}  // namespace gyrolog
