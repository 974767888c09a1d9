#include "analysis/diagnose/null_simulations.hpp"

#include <algorithm>
#include <mutex>

#include "analysis/compare/model_draw.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/counter_random.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {

namespace {

constexpr std::uint32_t seed_stream = 0x04000000;

std::vector<double> evidence_of_all(const std::vector<CatalogueEntry>& catalogue,
                                    const Observation& observation) {
    std::vector<double> evidence_nats(catalogue.size(), no_evidence_nats);
    for (std::size_t i = 0; i < catalogue.size(); ++i) {
        if (!catalogue[i].test) { continue; }
        const std::optional<Finding> finding = catalogue[i].test->find(observation);
        if (finding) { evidence_nats[i] = std::max(finding->evidence_nats, no_evidence_nats); }
    }
    return evidence_nats;
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

std::optional<NullSimulations> simulate_null(const std::shared_ptr<const Baseline>& baseline,
                                             const std::vector<CatalogueEntry>* catalogue,
                                             const NullSimulationOptions& options) {
    NullSimulations null;
    null.curves.resize(options.simulations);
    if (catalogue != nullptr) { null.evidence_nats.resize(options.simulations); }
    const RandomStream seeds(options.seed, seed_stream);
    std::mutex mutex;
    std::size_t done = 0;
    bool stopped = false;
    parallel_for(options.simulations, options.threads, [&](std::size_t i) {
        {
            const std::lock_guard lock(mutex);
            if (stopped) { return; }
        }
        const auto seed = static_cast<std::uint64_t>(seeds.uniform(i) * 0x1p32);
        SimulationRequest request;
        request.like = baseline->quiet_world();
        request.seed = seed;
        SensorModel model = draw_within_uncertainty(baseline->model(), seed);
        model.ref_noise_rad_s = 0.0;  // the observation draws it
        const auto recording = std::make_shared<const Recording>(simulate_recording(model, request));
        const Observation observation(baseline, recording, seed, Observation::ReferenceNoise::drawn);
        null.curves[i] = gap_curves(observation);
        if (catalogue != nullptr) { null.evidence_nats[i] = evidence_of_all(*catalogue, observation); }
        const std::lock_guard lock(mutex);
        ++done;
        const double share = static_cast<double>(done) / static_cast<double>(options.simulations);
        if (options.on_progress && !options.on_progress(share)) { stopped = true; }
    });
    if (stopped) { return std::nullopt; }
    return null;
}

}  // namespace gyrolog
