// The null judgement tells how often chance has a recording as far off as it is, if it comes from the model.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/calibration/null_simulations.hpp"
#include "analysis/diagnose/calibration/resolutions.hpp"
#include "analysis/diagnose/decision_options.hpp"
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

struct NullJudgementOptions {
    NullSimulationOptions simulations;
    // Probability that one effect more is found where there is none: half of the false alarms that a
    // diagnosis allows itself.
    double chance_of_an_effect = decisions.false_alarms_most / 2.0;
    double evidence_least_nats = decisions.strong_nats;
    // Of all false alarms, those of the stamps: a weighted Bonferroni bound (Holm 1979). Simulations copy the
    // stamps, so that their chance is not known as well as the others'.
    double share_of_stamps = 0.05;
    std::size_t simulations_for_floor = resolution::simulations_for_floor;
};

// `hypotheses` are those of the recording under the model. The function returns no value when ended early.
std::optional<NullJudgement> judge_null(const Hypotheses& hypotheses, const NullJudgementOptions& options);

// The rank of the recording's rarest look, the best effect or the worst curve, among the simulations': each
// of them is held against the others as the recording is against all, so that the probability is right over
// its whole range, however the looks hang together. `effects_nats`, `curves_nats`: by simulation.
double probability_by_rank(double effect_nats, const std::vector<double>& effects_nats, double curve_nats,
                           const std::vector<double>& curves_nats);

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
    // Where p is between these, it is asked of so many times more simulations.
    double doubted_below_p = decisions.false_alarms_most / 2.0;
    double doubted_above_p = resolution::impossible_p;
    std::size_t times_more_at_rest = resolution::times_more_at_rest;
    std::size_t times_more_in_motion = resolution::times_more_in_motion;
};

// `prediction` is of the model with the causes. The function returns no value when ended early.
std::optional<Remainder> judge_remainder(const std::shared_ptr<const Prediction>& prediction,
                                         const Observation& observation, const RemainderOptions& options);

}  // namespace gyrolog
