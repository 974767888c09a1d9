// When a line that a model has swings in a recording.
#pragma once

#include <cstdint>
#include <memory>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct ObservedLine {
    double phase_rad = 0.0;
    double share = 0.0;  // of the amplitude that the line has, 0 where it is not in the recording
};

// Of `line`, an entry of the prediction's model whose effect has EvidenceMethod::line, what fits the
// recording best: the model's answer to it is linear in the cosine and the sine of its phase. `seed` for what
// stands in holes.
ObservedLine observe_line(const Prediction& prediction, const std::shared_ptr<const Recording>& recording,
                          const EffectModel& line, std::uint64_t seed);

}  // namespace gyrolog
