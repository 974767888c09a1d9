// A long diagnosis is that of a recording which is too long to be judged sample by sample. It takes two
// passes: over the beginning as it is, for what is fast, and over all of it in means of samples, for what is
// slow.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "analysis/diagnose/diagnosis.hpp"

namespace gyrolog {

namespace resolution {

// With these lengths a diagnosis takes less than 1 GB: 15 min at 1 kHz, and 24 h in means of 0.1 s.
inline constexpr std::size_t beginning_max = 900'000;
inline constexpr std::size_t means_max = 900'000;

}  // namespace resolution

// Both are of one recording at rest; each alone has no diagnosis_refusal().
struct LongRecording {
    std::shared_ptr<const Recording> beginning;
    std::shared_ptr<const Recording> means;
};

// A cause belongs to the pass that sees more of it: what keeps less than half of its spectral gain when the
// beginning is seen in means, or does not show in them at all, is fast and stays as the beginning has it. The
// means are held against a model with the fast causes and with as much white noise as the means themselves
// have: what spikes, repeated samples or fast noise leave in them is white, and how white the samples are the
// beginning tells better. What is slow comes from the means. A beginning that is not explained is judged once
// more with the slow causes in its model. joined_passes() makes one answer of both; each calls a gap half as
// often by chance.
//
// Of a second recording options.holdout is held against the beginning and `holdout_means`, of as many
// samples, against the means; either may be null.
std::optional<Diagnosis> diagnose_long(const LongRecording& recording, const SensorModel& model,
                                       const std::string& model_name, const DiagnosisOptions& options,
                                       std::shared_ptr<const Recording> holdout_means = nullptr);

}  // namespace gyrolog
