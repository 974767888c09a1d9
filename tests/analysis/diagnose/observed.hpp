// Test side only: recordings of a simulated sensor, and what a test finds in them.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "analysis/diagnose/effect_test.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {

inline std::shared_ptr<const Recording> recorded(const SensorModel& model, std::uint64_t samples,
                                                 std::uint64_t seed,
                                                 std::shared_ptr<const World> world = nullptr) {
    SimulationRequest request;
    request.samples = samples;
    request.seed = seed;
    request.world = std::move(world);
    return std::make_shared<const Recording>(simulate_recording(model, request));
}

inline std::shared_ptr<const Baseline> baseline_of(const std::shared_ptr<const Recording>& recording,
                                                   const SensorModel& model) {
    return std::make_shared<const Baseline>(std::make_shared<const RecordedWorld>(recording), model);
}

inline SensorModel with_entry(SensorModel model, const char* effect, std::map<std::string, double> params,
                              std::vector<std::string> axes = {}) {
    model.effects.push_back(
        {.effect = effect, .axes = std::move(axes), .params = std::move(params), .carried_json = {}});
    return model;
}

// Of the recording under the model.
inline std::optional<Finding> found(TestMaker make, const char* effect,
                                    const std::shared_ptr<const Recording>& recording,
                                    const SensorModel& model) {
    const auto baseline = baseline_of(recording, model);
    const MadeTest made = make(*find_effect(effect), baseline);
    return made.test ? made.test->find(Observation(baseline, recording, 1)) : std::nullopt;
}

inline double evidence(const std::optional<Finding>& finding) {
    return finding ? finding->evidence_nats : 0.0;
}

// The model with what was found.
inline SensorModel with_found(SensorModel model, const Finding& finding) {
    model.effects.insert(model.effects.end(), finding.entries.begin(), finding.entries.end());
    return model;
}

}  // namespace gyrolog
