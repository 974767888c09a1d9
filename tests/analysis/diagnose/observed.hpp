// Test side only: recordings of a simulated sensor, and what a test finds in them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/diagnose/estimators/estimator.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "tests/analysis/simulate/simulated.hpp"
#include "tests/support/asked.hpp"

namespace gyrolog {

// Of whole selections the long tier asks for more.
inline std::uint64_t seeds_asked(std::uint64_t otherwise) {
    return static_cast<std::uint64_t>(asked("GYROLOG_REALISATIONS", static_cast<double>(otherwise)));
}

inline std::shared_ptr<const Recording> recorded(const SensorModel& model, std::uint64_t samples,
                                                 std::uint64_t seed,
                                                 std::shared_ptr<const World> world = nullptr) {
    SimulationRequest request;
    request.samples = samples;
    request.seed = seed;
    request.world = std::move(world);
    return std::make_shared<const Recording>(simulate_recording(model, request));
}

// Without x, with y that says one code all the time.
inline std::shared_ptr<const Recording> few_samples_with_a_dead_axis(const SensorModel& model,
                                                                     std::uint64_t seed) {
    Recording recording = *recorded(model, 2048, seed);
    auto& counts = std::get<std::vector<std::int16_t>>(recording.columns[1].data);
    std::ranges::fill(counts, std::int16_t{3});
    recording.columns.erase(recording.columns.begin());
    return std::make_shared<const Recording>(std::move(recording));
}

inline std::shared_ptr<const Prediction> prediction_of(const std::shared_ptr<const Recording>& recording,
                                                       const SensorModel& model) {
    return std::make_shared<const Prediction>(std::make_shared<const RecordedWorld>(recording), model);
}

// A typical sensor's white noise and, beside it, slow noise; the model knows them as a calibration does.
inline SensorModel calibrated_sensor(double N_dps_per_sqrt_hz = 0.005) {
    SensorModel model = typical_mpu9250();
    for (AxisModel& axis : model.axes) {
        axis.noise = {};
        axis.noise.N_rad_per_sqrt_s = N_dps_per_sqrt_hz * rad_per_deg;
        axis.noise.B_rad_per_s = 0.0015 * rad_per_deg;
        axis.noise.K_rad_per_s_sqrt_s = 1e-4 * rad_per_deg;
    }
    model.sd_rel = {{"N", 0.005}, {"B", 0.08}, {"K", 0.2}};
    return model;
}

// Of the recording under the model.
inline std::optional<Finding> found(EstimatorMaker make, const char* effect,
                                    const std::shared_ptr<const Recording>& recording,
                                    const SensorModel& model) {
    const auto prediction = prediction_of(recording, model);
    const MadeEstimator made = make(*find_effect(effect), prediction);
    return made.estimator ? made.estimator->find(Observation(prediction, recording, 1)) : std::nullopt;
}

inline double evidence(const std::optional<Finding>& finding) {
    return finding ? finding->evidence_nats : 0.0;
}

}  // namespace gyrolog
