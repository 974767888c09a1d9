#include "analysis/diagnose/likelihood/corrected_model.hpp"

#include <utility>
#include <vector>

#include "analysis/diagnose/likelihood/noise_refit.hpp"

namespace gyrolog {

SensorModel with_cause(SensorModel model, const Finding& finding) {
    model.effects.insert(model.effects.end(), finding.entries.begin(), finding.entries.end());
    return model;
}

SensorModel corrected_model(SensorModel model, const Diagnosis& diagnosis, const SensorModel& centred) {
    model = with_noise(std::move(model), diagnosis.noise_refits);
    for (const Cause& cause : diagnosis.causes) { model = with_cause(std::move(model), cause.finding); }
    for (const std::size_t axis : diagnosis.axes) {
        model.axes[axis].bias_rad_s = centred.axes[axis].bias_rad_s;
    }
    return model;
}

SensorModel with_unnamed(SensorModel model, const Diagnosis& diagnosis) {
    const bool is_gyro = diagnosis.unit.sensor == SensorKind::gyro;
    std::vector<EffectModel>& effects = is_gyro ? model.effects : model.accelerometer->effects;
    for (const Unnamed& form : diagnosis.unnamed) {
        effects.insert(effects.end(), form.entries.begin(), form.entries.end());
    }
    return model;
}

}  // namespace gyrolog
