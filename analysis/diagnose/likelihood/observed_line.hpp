// An observed line is a line of the model as the recording has it: what swings had another phase at another
// first sample.
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

// The function fits `line`, an entry of the prediction's model whose effect is a line, to the recording by
// least squares: the model's answer to it is linear in the cosine and the sine of its phase. `seed` draws
// what stands in holes.
ObservedLine observe_line(const Prediction& prediction, const std::shared_ptr<const Recording>& recording,
                          const EffectModel& line, std::uint64_t seed);

}  // namespace gyrolog
