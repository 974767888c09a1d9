// Null simulations are what a recording would look like by chance: simulations of a model, like it in
// everything but the noise.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/measures/gap_curves.hpp"
#include "analysis/simulate/random_purpose.hpp"

namespace gyrolog {

namespace resolution {

inline constexpr double no_evidence_nats = -50.0;

}  // namespace resolution

struct NullSimulations {
    std::vector<std::vector<GapCurve>> curves;  // by simulation
    // By simulation, by entry of the catalogue; empty unless asked for. An effect without a trace has
    // no_evidence_nats.
    std::vector<std::vector<double>> evidence_nats;
};

// By simulation: the evidence of the effect that has the most.
std::vector<double> best_evidence_nats(const NullSimulations& null);

struct NullSimulationOptions {
    std::size_t simulations = 200;
    std::uint64_t seed = 1;
    RandomPurpose purpose = RandomPurpose::null_simulations;
    unsigned threads = 0;
    std::function<bool(double)> on_progress{};  // with the share that is done; false ends the work
    // Each simulation of a sensor that moves has its reference measured anew and is judged like the
    // recording: what the reference's noise does at a dead zone's edge no likelihood knows. It is several
    // times as slow, and gives curves only.
    bool measure_anew = false;
};

// The function draws sensors within the model's stated uncertainty. `catalogue` is that of the same
// prediction, or null where only curves are wanted. It returns no value when ended early.
std::optional<NullSimulations> simulate_null(const std::shared_ptr<const Prediction>& prediction,
                                             const std::vector<CatalogueEntry>* catalogue,
                                             const NullSimulationOptions& options);

}  // namespace gyrolog
