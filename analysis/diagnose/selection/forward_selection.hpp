// The forward selection tells which effects, alone or together, a recording calls for.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/calibration/null_bias.hpp"
#include "analysis/diagnose/estimators/hypotheses.hpp"
#include "analysis/diagnose/report.hpp"
#include "analysis/diagnose/selection/cause_set.hpp"

namespace gyrolog {

struct CauseSelection {
    std::vector<FoundCause> causes;        // by evidence
    std::vector<NoiseRefit> noise_refits;  // where the model that was given held part of the causes
    SensorModel without_causes;            // noise that held part of them is free
    SensorModel corrected;
    NullBias null_bias;  // was taken off the findings beside the main cause
    Hypotheses last;     // under the corrected model
};

// The function selects greedily, by evidence. After each new cause all are fitted again, one by one, with the
// others in the model, and those that the others made needless are dropped. A cause stays where all measures
// together are better explained with it: the spectra's likelihood, and what each cause gains beside them.
// `first` is under the model as it was given. The function returns no value when ended early.
std::optional<CauseSelection> select_causes(const Hypotheses& first,
                                            const std::shared_ptr<const Recording>& recording,
                                            const SelectionOptions& options);

// The function takes one of the causes out and fits the others again: what they were with it in the model,
// they are not without it (a low-pass beside more white noise is half of an answer). One without evidence
// then goes, too. `first` and `options` are those of the selection. The function returns no value when ended
// early.
std::optional<CauseSelection> without_cause(CauseSelection found, std::size_t cause, const Hypotheses& first,
                                            const std::shared_ptr<const Recording>& recording,
                                            const SelectionOptions& options);

}  // namespace gyrolog
