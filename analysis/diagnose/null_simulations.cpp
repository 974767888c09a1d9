#include "analysis/diagnose/null_simulations.hpp"

#include <algorithm>
#include <limits>
#include <mutex>

#include "analysis/compare/model_draw.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/counter_random.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {

namespace {

constexpr std::uint32_t seed_stream = 0x04000000;

double best_evidence(const std::vector<CatalogueEntry>& catalogue, const Observation& observation) {
    double best = -std::numeric_limits<double>::max();
    for (const CatalogueEntry& entry : catalogue) {
        if (!entry.test) { continue; }
        const std::optional<Finding> finding = entry.test->find(observation);
        if (finding) { best = std::max(best, finding->evidence_nats); }
    }
    // Where no effect has any trace, no evidence at all: as little as can be.
    return std::max(best, -50.0);
}

}  // namespace

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
        if (catalogue != nullptr) { null.evidence_nats[i] = best_evidence(*catalogue, observation); }
        const std::lock_guard lock(mutex);
        ++done;
        const double share = static_cast<double>(done) / static_cast<double>(options.simulations);
        if (options.on_progress && !options.on_progress(share)) { stopped = true; }
    });
    if (stopped) { return std::nullopt; }
    return null;
}

}  // namespace gyrolog
