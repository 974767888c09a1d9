#include "analysis/diagnose/likelihood/effect_response.hpp"

#include <algorithm>

#include "analysis/diagnose/likelihood/hole_filling.hpp"
#include "analysis/numerics/cosine_transform.hpp"

namespace gyrolog {

namespace {

std::array<std::vector<float>, 3> simulated_response(const Prediction& prediction, const EffectModel& effect,
                                                     bool slow) {
    // A slow response is a drift of the bias: any sensor at rest shows it.
    SensorModel without = slow ? SensorModel{} : prediction.model();
    if (slow) {
        without.rate_hz = prediction.model().rate_hz;
        without.full_scale_rad_s = without.saturation_rad_s = 1e6;
    }
    SensorModel with = without;
    with.effects.push_back(effect);
    const std::shared_ptr<const RecordedWorld> world =
        slow ? prediction.shared_world() : prediction.denoised_world();
    const auto changed = noise_free_response(prediction, world, with);
    const auto unchanged =
        slow ? noise_free_response(prediction, without) : std::array<std::vector<float>, 3>{};
    const std::size_t kept =
        slow ? std::min(resolution::slow_coefficients, prediction.length()) : prediction.length();
    const TransformPool::Lease transform = prediction.transform();
    std::vector<double> work(prediction.length());
    std::array<std::vector<float>, 3> cosines;
    for (const std::size_t axis : prediction.axes()) {
        if (slow && axis != prediction.axes().front()) {
            cosines[axis] = cosines[prediction.axes().front()];
            continue;
        }
        const std::vector<float>& before = slow ? unchanged[axis] : prediction.denoised_response_rad_s(axis);
        for (std::size_t slot = 0; slot < work.size(); ++slot) {
            work[slot] = static_cast<double>(changed[axis][slot]) - static_cast<double>(before[slot]);
        }
        cosines[axis] = response_cosines(prediction, axis, work, *transform);
        cosines[axis].resize(kept);
    }
    return cosines;
}

}  // namespace

std::array<std::vector<float>, 3> effect_response(const Prediction& prediction, const EffectModel& effect,
                                                  bool slow) {
    if (!slow) { return simulated_response(prediction, effect, slow); }
    return prediction.memory().recall({effect.effect, effect.params},
                                      [&] { return simulated_response(prediction, effect, slow); });
}

}  // namespace gyrolog
