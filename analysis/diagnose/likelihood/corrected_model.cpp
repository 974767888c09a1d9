#include "analysis/diagnose/likelihood/corrected_model.hpp"

#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/likelihood/noise_refit.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

SensorModel with_cause(SensorModel model, const Finding& finding) {
    model.effects.insert(model.effects.end(), finding.entries.begin(), finding.entries.end());
    return model;
}

SensorModel with_open_cause(SensorModel model, const Finding& finding) {
    const EffectSignature* signature = find_effect(finding.effect)->signature;
    if (signature != nullptr && signature->slow_coefficient != 0) {
        const std::string coefficient(1, signature->slow_coefficient);
        for (const std::size_t axis : finding.where.axes) {
            model.axes[axis].sd_rel[coefficient] = decisions.unknown_sd_rel;
        }
    }
    return with_cause(std::move(model), finding);
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
