// Every recording has a start of its own that no model knows: the bias since it was turned on, and the phase
// that a line had at the first sample. Where the output clips, and where it lies between two codes, the bias
// matters.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/diagnose/likelihood/prediction.hpp"

namespace gyrolog {

struct OwnStart {
    std::shared_ptr<const Prediction> prediction;  // of the model with the recording's start
    // Lines of the model that are nearer to be absent than present: less than half of their amplitude.
    std::vector<double> faint_lines_hz;
    std::vector<std::string> warnings;  // of those
};

OwnStart with_own_start(const std::shared_ptr<const Prediction>& prediction,
                        const std::shared_ptr<const Recording>& recording, std::uint64_t seed);

// The model with the bias that leaves nothing of the observation's mean.
SensorModel with_mean_of(const Observation& observation, SensorModel model);

}  // namespace gyrolog
