// Replicates are recordings of sensors drawn from what a model leaves open, like one that is judged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/simulate/random_purpose.hpp"

namespace gyrolog {

// The replicate is like the prediction's recording in everything but the gyros: its stamps, its temperature,
// and its denoised world for the motion, as it was measured without noise.
Recording replicate_recording(const Prediction& prediction, const SensorModel& model, std::uint64_t seed);

// The function replaces the columns of what is taken for the truth, the reference rate and the specific
// force, as `model` measures them: with noise anew.
Recording measured_anew(Recording recording, const SensorModel& model, std::uint64_t seed);

// The reference of a sensor that moves can, where a model states its noise: an orientation's none does. More
// than a million samples cannot, for the memory that a world of their own takes.
bool can_be_measured_anew(const Prediction& prediction);

struct ReplicateOptions {
    std::size_t count = 0;
    std::uint64_t seed = 1;
    RandomPurpose purpose = RandomPurpose::null_simulations;
    unsigned threads = 0;
    std::function<bool(double)> on_progress{};  // with the share that is done; false ends the work
};

// The function calls task(i, seed) for each i below the count, as parallel_for() does. It returns false when
// ended early.
bool for_each_replicate(const ReplicateOptions& options,
                        const std::function<void(std::size_t i, std::uint64_t seed)>& task);

}  // namespace gyrolog
