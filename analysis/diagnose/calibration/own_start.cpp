#include "analysis/diagnose/calibration/own_start.hpp"

#include <array>
#include <cstdio>
#include <utility>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/observed_line.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

namespace {

std::string faint_line_sentence(const EffectModel& line, double share) {
    const EffectValues values(line);
    std::array<char, 160> text{};
    (void)std::snprintf(text.data(), text.size(),
                        "the model's %s at %.5g Hz has %.0f %% of its amplitude in the recording: one at "
                        "that frequency among the causes takes it off again",
                        line.effect.c_str(), values["f_hz"], 100.0 * share);
    return text.data();
}

}  // namespace

OwnStart with_own_start(const std::shared_ptr<const Prediction>& prediction,
                        const std::shared_ptr<const Recording>& recording, std::uint64_t seed) {
    OwnStart start;
    SensorModel model = prediction->model();
    for (EffectModel& entry : model.effects) {
        if (!traits_of(entry.effect).is_line) { continue; }
        const ObservedLine seen = observe_line(*prediction, recording, entry, seed);
        entry.params["phase_rad"] = seen.phase_rad;
        if (seen.share < definition::majority) {
            start.faint_lines_hz.push_back(EffectValues(entry)["f_hz"]);
            start.warnings.push_back(faint_line_sentence(entry, seen.share));
        }
    }
    const Observation observation(prediction->with(model), recording, seed);
    start.prediction = prediction->with(with_mean_of(observation, std::move(model)));
    return start;
}

SensorModel with_mean_of(const Observation& observation, SensorModel model) {
    for (const std::size_t axis : observation.prediction().axes()) {
        model.axes[axis].bias_rad_s += observation.axis(axis).mean_rad_s;
    }
    return model;
}

}  // namespace gyrolog
