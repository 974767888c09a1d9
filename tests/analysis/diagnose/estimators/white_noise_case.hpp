// Test side only: a still sensor with a known model, recorded with and without effects on its white noise.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "analysis/compare/model_draw.hpp"
#include "analysis/diagnose/estimators/estimator.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {

inline SensorModel known_sensor() {
    SensorModel model = typical_mpu9250();
    model.sd_rel = {{"N", 0.03}, {"B", 0.1}, {"K", 0.2}};
    return model;
}

struct WhiteNoiseCase {
    std::shared_ptr<const Recording> recording;
    std::shared_ptr<const Prediction> prediction;
    std::shared_ptr<const Observation> seen;

    std::optional<Finding> find(const char* effect, EstimatorMaker make) const {
        const MadeEstimator made = make(*find_effect(effect), prediction);
        return made.estimator ? made.estimator->find(*seen) : std::nullopt;
    }
    // 0 without a finding. Next to a test that it is none stands one that the estimator answers.
    double evidence_nats(const char* effect, EstimatorMaker make) const {
        const std::optional<Finding> found = find(effect, make);
        return found ? found->evidence_nats : 0.0;
    }
    std::string untestable(const char* effect, EstimatorMaker make) const {
        return make(*find_effect(effect), prediction).untestable;
    }
};

inline WhiteNoiseCase seen_with(const SensorModel& model, std::shared_ptr<const Recording> recording) {
    WhiteNoiseCase made;
    made.recording = std::move(recording);
    made.prediction =
        std::make_shared<const Prediction>(std::make_shared<const RecordedWorld>(made.recording), model);
    made.seen = std::make_shared<const Observation>(made.prediction, made.recording, 1);
    return made;
}

// What a sensor drawn within `model`'s uncertainty records with these effects, seen with `model`.
inline WhiteNoiseCase seen_effects(const SensorModel& model, std::vector<EffectModel> effects,
                                   std::uint64_t samples, std::uint64_t seed,
                                   std::shared_ptr<const World> world = nullptr) {
    SensorModel sensor = model;
    for (EffectModel& effect : effects) { sensor.effects.push_back(std::move(effect)); }
    SimulationRequest request;
    request.samples = samples;
    request.seed = seed;
    request.world = std::move(world);
    return seen_with(model, std::make_shared<const Recording>(
                                simulate_recording(draw_within_uncertainty(sensor, seed), request)));
}

// Up and down by 10 degC within an hour.
inline std::shared_ptr<const World> swept_temperature() {
    auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = [](double t_s) { return 30.0 + 5.0 * triangle(t_s / 3600.0); };
    return world;
}

}  // namespace gyrolog
