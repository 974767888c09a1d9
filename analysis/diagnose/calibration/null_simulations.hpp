// What a recording would look like by chance: simulations of a model, like it in everything but the noise.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/measures/gap_curves.hpp"

namespace gyrolog {

struct NullSimulations {
    std::vector<std::vector<GapCurve>> curves;  // by simulation
    // By simulation, by entry of the catalogue; empty unless asked for. Where an effect has no trace,
    // no_evidence_nats.
    std::vector<std::vector<double>> evidence_nats;
};

inline constexpr double no_evidence_nats = -50.0;

// By simulation: of the effect that has the most.
std::vector<double> best_evidence_nats(const NullSimulations& null);

struct NullSimulationOptions {
    std::size_t simulations = 200;
    std::uint64_t seed = 1;
    unsigned threads = 0;
    std::function<bool(double)> on_progress{};  // with the share that is done; false ends the work
    // Where the sensor moves, each with its reference measured anew and looked at like the recording's: what
    // the reference's noise does at a dead zone's edge no likelihood knows. Several times as slow; curves
    // only.
    bool measure_anew = false;
};

// Sensors are drawn within the model's stated uncertainty. `catalogue`: of the same prediction, or null where
// only curves are wanted. No value when ended early.
std::optional<NullSimulations> simulate_null(const std::shared_ptr<const Prediction>& prediction,
                                             const std::vector<CatalogueEntry>* catalogue,
                                             const NullSimulationOptions& options);

}  // namespace gyrolog
