// Recordings of sensors drawn from what a model leaves open, like one that is looked at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "analysis/diagnose/likelihood/prediction.hpp"

namespace gyrolog {

// Like the prediction's in everything but the gyros: its stamps, its temperature, and its denoised world for
// the motion, as it was measured without noise.
Recording replicate_recording(const Prediction& prediction, const SensorModel& model, std::uint64_t seed);

// The columns of what is taken for the truth, the reference rate and the specific force, as `model` measures
// them: with noise anew.
Recording measured_anew(Recording recording, const SensorModel& model, std::uint64_t seed);

// Not where the reference is an orientation, whose noise no model states, nor, for the memory that a world of
// their own takes, of more than a million samples.
bool can_be_measured_anew(const Recording& recording);

struct ReplicateOptions {
    std::size_t count = 0;
    std::uint64_t seed = 1;
    std::uint32_t stream = 0;  // of the seeds: draws for different ends share nothing
    unsigned threads = 0;
    std::function<bool(double)> on_progress{};  // with the share that is done; false ends the work
};

// Calls task(i, seed) for each i below the count, as parallel_for() does. False when ended early.
bool for_each_replicate(const ReplicateOptions& options,
                        const std::function<void(std::size_t i, std::uint64_t seed)>& task);

}  // namespace gyrolog
