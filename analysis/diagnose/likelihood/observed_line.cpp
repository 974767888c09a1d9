#include "analysis/diagnose/likelihood/observed_line.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog {

namespace {

bool same(const EffectModel& a, const EffectModel& b) {
    return a.effect == b.effect && a.axes == b.axes && a.params == b.params;
}

}  // namespace

ObservedLine observe_line(const Prediction& prediction, const std::shared_ptr<const Recording>& recording,
                          const EffectModel& line, std::uint64_t seed) {
    SensorModel without = prediction.model();
    const auto own =
        std::ranges::find_if(without.effects, [&](const EffectModel& e) { return same(e, line); });
    if (own != without.effects.end()) { without.effects.erase(own); }
    const auto answer_at = [&](double phase_rad) {
        SensorModel model = without;
        model.effects.push_back(line);
        model.effects.back().params["phase_rad"] = phase_rad;
        return noise_free_response(prediction, model);
    };
    const auto zero = answer_at(0.0);
    const auto quarter = answer_at(0.5 * pi);
    const auto nothing = noise_free_response(prediction, without);
    const Observation observation(prediction.with(without), recording, seed);
    double cosine = 0.0;
    double sine = 0.0;
    double squares = 0.0;
    for (const std::size_t axis : prediction.axes()) {
        if (!acts_on(line, axis)) { continue; }
        const std::vector<float>& residual = observation.axis(axis).residual_rad_s;
        for (std::size_t slot = 0; slot < residual.size(); ++slot) {
            if (!observation.present()[slot]) { continue; }
            const auto rate = static_cast<double>(residual[slot]);
            const auto at_zero = static_cast<double>(zero[axis][slot] - nothing[axis][slot]);
            const auto at_quarter = static_cast<double>(quarter[axis][slot] - nothing[axis][slot]);
            cosine += rate * at_zero;
            sine += rate * at_quarter;
            squares += 0.5 * (at_zero * at_zero + at_quarter * at_quarter);
        }
    }
    return {std::atan2(sine, cosine), squares > 0.0 ? std::hypot(cosine, sine) / squares : 0.0};
}

}  // namespace gyrolog
