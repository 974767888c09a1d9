#include "analysis/diagnose/calibration/replicates.hpp"

#include <mutex>
#include <utility>
#include <vector>

#include "analysis/compare/model_draw.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog::resolution {

constexpr std::size_t rows_measured_anew_most = 1'000'000;

}  // namespace gyrolog::resolution

namespace gyrolog {

Recording replicate_recording(const Prediction& prediction, const SensorModel& model, std::uint64_t seed) {
    SimulationRequest request;
    request.like = prediction.denoised_world();
    request.seed = seed;
    SensorModel drawn = draw_within_uncertainty(model, seed);
    drawn.ref_noise_rad_s = 0.0;
    return simulate_recording(drawn, request);
}

Recording measured_anew(Recording recording, const SensorModel& model, std::uint64_t seed) {
    std::uint64_t number = 0;
    for (Column& column : recording.columns) {
        const bool is_rate = column.name == "ref_x" || column.name == "ref_y" || column.name == "ref_z";
        const bool is_force = column.name == "ax" || column.name == "ay" || column.name == "az";
        if (!is_rate && !is_force) { continue; }
        const double sd = is_rate ? model.ref_noise_rad_s : model.acc_noise_m_s2;
        const RandomStream noise = derived_stream(seed, RandomPurpose::reference_measured_anew, number++);
        std::vector<double> values = column.values();
        for (std::size_t row = 0; row < values.size(); ++row) { values[row] += sd * noise.normal(row); }
        column.data = std::move(values);
        column.scale = 1.0;
        column.offset = 0.0;
    }
    return recording;
}

bool can_be_measured_anew(const Prediction& prediction) {
    if (!prediction.moves() || !prediction.noise_is_sensors()) { return false; }
    const Recording& recording = prediction.world().recording();
    const bool has_rate = recording.find("ref_x") != nullptr || recording.find("ref_y") != nullptr ||
                          recording.find("ref_z") != nullptr;
    return has_rate && recording.rows() <= resolution::rows_measured_anew_most;
}

bool for_each_replicate(const ReplicateOptions& options,
                        const std::function<void(std::size_t i, std::uint64_t seed)>& task) {
    std::mutex mutex;
    std::size_t done = 0;
    bool stopped = false;
    parallel_for(options.count, options.threads, [&](std::size_t i) {
        {
            const std::lock_guard lock(mutex);
            if (stopped) { return; }
        }
        task(i, derived_seed(options.seed, options.purpose, i));
        const std::lock_guard lock(mutex);
        ++done;
        const double share = static_cast<double>(done) / static_cast<double>(options.count);
        if (options.on_progress && !options.on_progress(share)) { stopped = true; }
    });
    return !stopped;
}

}  // namespace gyrolog
