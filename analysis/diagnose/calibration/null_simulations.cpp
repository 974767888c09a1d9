#include "analysis/diagnose/calibration/null_simulations.hpp"

#include <algorithm>
#include <utility>

#include "analysis/diagnose/calibration/replicates.hpp"

namespace gyrolog {

namespace {

std::vector<double> evidence_of_all(const std::vector<CatalogueEntry>& catalogue,
                                    const Observation& observation) {
    std::vector<double> evidence_nats(catalogue.size(), resolution::no_evidence_nats);
    for (std::size_t i = 0; i < catalogue.size(); ++i) {
        if (!catalogue[i].estimator) { continue; }
        const std::optional<Finding> finding = catalogue[i].estimator->find(observation);
        if (finding) { evidence_nats[i] = std::max(finding->evidence_nats, resolution::no_evidence_nats); }
    }
    return evidence_nats;
}

std::vector<GapCurve> curves_measured_anew(const Prediction& prediction, Recording simulated,
                                           std::uint64_t seed) {
    const SensorModel& model = prediction.model();
    const auto recording =
        std::make_shared<const Recording>(measured_anew(std::move(simulated), model, seed));
    const auto world = std::make_shared<const RecordedWorld>(recording);
    return gap_curves(Observation(prediction.in_world(world, model), recording, seed,
                                  Observation::ReferenceNoise::measured_anew));
}

}  // namespace

std::vector<double> best_evidence_nats(const NullSimulations& null) {
    std::vector<double> best;
    best.reserve(null.evidence_nats.size());
    for (const std::vector<double>& of_effects : null.evidence_nats) {
        best.push_back(std::ranges::max(of_effects));
    }
    return best;
}

std::optional<NullSimulations> simulate_null(const std::shared_ptr<const Prediction>& prediction,
                                             const std::vector<CatalogueEntry>* catalogue,
                                             const NullSimulationOptions& options) {
    NullSimulations null;
    null.curves.resize(options.simulations);
    if (catalogue != nullptr) { null.evidence_nats.resize(options.simulations); }
    const ReplicateOptions draws{options.simulations, options.seed, options.purpose, options.threads,
                                 options.on_progress};
    const bool done = for_each_replicate(draws, [&](std::size_t i, std::uint64_t seed) {
        Recording simulated = replicate_recording(*prediction, prediction->model(), seed);
        if (options.measure_anew && prediction->moves()) {
            null.curves[i] = curves_measured_anew(*prediction, std::move(simulated), seed);
            return;
        }
        const auto recording = std::make_shared<const Recording>(std::move(simulated));
        const Observation observation(prediction, recording, seed, Observation::ReferenceNoise::drawn);
        null.curves[i] = gap_curves(observation);
        if (catalogue != nullptr) { null.evidence_nats[i] = evidence_of_all(*catalogue, observation); }
    });
    if (!done) { return std::nullopt; }
    return null;
}

}  // namespace gyrolog
