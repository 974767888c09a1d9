// Recordings as a diagnosis takes them.
#pragma once

#include <memory>

#include "analysis/recording/recording.hpp"
#include "host/app/recording_input.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct DiagnosisInput {
    std::shared_ptr<const Recording> samples;  // for one pass; with means, the beginning
    std::shared_ptr<const Recording> means;    // of all, for another; else null
};

// As much as one pass takes, from the beginning; a recording at rest of more than that, with one sample per
// row, for two passes, in means of some 0.1 s. Where the means have a diagnosis_refusal() or another rate
// than the beginning, and of what is longer otherwise, there is a warning. Errors: those of read_recording(),
// and what has a diagnosis_refusal().
Result<DiagnosisInput> read_for_diagnosis(const RecordingInput& input);

// A second recording, for what the first one was read as: its means are of as many samples, of its beginning
// where they are more than one pass takes.
Result<DiagnosisInput> read_for_diagnosis(const RecordingInput& input, const DiagnosisInput& like);

}  // namespace gyrolog
