// The null judgement tells how often chance has a recording as far off as it is, if it comes from the model.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/calibration/null_simulations.hpp"
#include "analysis/diagnose/estimators/hypotheses.hpp"

namespace gyrolog {

struct NullJudgement {
    GapReference reference;        // of the model's simulations
    std::vector<GapCurve> curves;  // of the recording
    double p_none = 1.0;
    // By chance the effect with the most evidence reaches it in one recording of two hundred.
    double evidence_min_nats = 0.0;
    // Of the whole recording, in the sense of calibration/measured_gap.hpp: a simulation's surprisal, and
    // what the recording has more.
    double floor_nats = 0.0;
    double excess_nats = 0.0;
};

// `hypotheses` are those of the recording under the model. The function returns no value when ended early.
std::optional<NullJudgement> judge_null(const Hypotheses& hypotheses, const NullSimulationOptions& options);

// The evidence that the time stamps give to an effect, 0 or more. Simulations copy the stamps.
double stamp_evidence_nats(const Hypotheses& hypotheses);

// A remainder is what a model with causes leaves.
struct Remainder {
    GapReference reference;
    std::vector<GapCurve> curves;
    double p = 1.0;  // how often chance leaves as much
};

struct RemainderOptions {
    NullSimulationOptions simulations;
    // Where p is between these, simulations are added: in motion, where each is measured anew, twice as many,
    // else four times.
    double doubted_below_p = 0.005;
    double doubted_above_p = 1e-6;
};

// `prediction` is of the model with the causes. The function returns no value when ended early.
std::optional<Remainder> judge_remainder(const std::shared_ptr<const Prediction>& prediction,
                                         const Observation& observation, const RemainderOptions& options);

}  // namespace gyrolog
