// The diagnosis: where a recording and its model part, which effect it is, and how far the gap closes with
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/calibration/resolutions.hpp"
#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/report.hpp"
#include "analysis/diagnose/selection/verdict.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct DiagnosisOptions {
    std::uint64_t seed = 1;
    std::size_t simulations = 200;
    // A gap is called where chance would have it no more often; what causes leave, half as often.
    double false_alarms_most = decisions.false_alarms_most;
    // Of the corrected model, to judge what it leaves.
    std::size_t simulations_after_most = resolution::simulations_after_most;
    // 0: all processors, fewer where their simulations would take more than `simulations_bytes_most` at a
    // time. The result is the same for any number.
    unsigned threads = 0;
    double simulations_bytes_most = resolution::simulations_bytes_most;
    std::shared_ptr<const Recording> holdout{};
    Prediction::NoiseOf noise_of = Prediction::NoiseOf::sensor;
    // Effects that a person describes; without effect_refusal().
    std::vector<DescribedEffect> asked{};
    // With what is being done and its share from 0 to 1; false ends the work.
    std::function<bool(const char*, double)> on_progress{};
};

// `recording` has no diagnosis_refusal(), `model` no simulation_refusal(). The function returns no value when
// the work was ended early.
std::optional<Diagnosis> diagnose(std::shared_ptr<const Recording> recording, const SensorModel& model,
                                  const std::string& model_name, const DiagnosisOptions& options = {});

// The function appends the sentences that are not there yet.
void append_new(std::vector<std::string>& to, const std::vector<std::string>& from);

}  // namespace gyrolog
