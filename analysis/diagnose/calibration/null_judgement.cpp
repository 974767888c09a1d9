#include "analysis/diagnose/calibration/null_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "analysis/diagnose/calibration/evidence_tail.hpp"
#include "analysis/diagnose/calibration/replicates.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"

namespace gyrolog {

namespace {

constexpr double chance_of_an_effect = 0.005;
constexpr double evidence_least_nats = 3.0;
constexpr std::size_t times_more_in_doubt = 4;
constexpr std::size_t times_more_in_motion = 2;

bool are_alike(const GapCurve& a, const GapCurve& b) {
    return a.measure == b.measure && a.axis == b.axis && a.other == b.other &&
           a.value.size() == b.value.size();
}

double best_evidence_nats(const Hypotheses& hypotheses, bool in_stamps) {
    double best = no_evidence_nats;
    for (const std::optional<Finding>& finding : hypotheses.findings) {
        if (finding && traits_of(finding->effect).is_in_stamps == in_stamps) {
            best = std::max(best, finding->evidence_nats);
        }
    }
    return best;
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

// Some simulations are enough for their mean.
double mean_surprisal_nats(const SimulatedCurves& simulations) {
    constexpr std::size_t simulations_most = 40;
    const std::size_t count = std::min(simulations_most, simulations.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        sum += sum_of(measure_surprises_nats(simulations[i], gap_reference(simulations, i)));
    }
    return sum / static_cast<double>(count);
}

// The function leaves `remainder` as it is where few simulations have curves like the recording's.
bool judge(Remainder& remainder, const std::shared_ptr<const Prediction>& prediction,
           const NullSimulationOptions& options) {
    std::optional<NullSimulations> null = simulate_null(prediction, nullptr, options);
    if (!null) { return false; }
    // An axis at rest may seem to move where it is measured anew, and has other curves then.
    std::erase_if(null->curves, [&](const std::vector<GapCurve>& curves) {
        return !std::ranges::equal(curves, remainder.curves, are_alike);
    });
    if (null->curves.size() < options.simulations / 2) { return true; }
    remainder.reference = gap_reference(null->curves);
    remainder.p = EvidenceTail(simulated_surprises_nats(null->curves))
                      .probability(worst_surprise_nats(remainder.curves, remainder.reference));
    return true;
}

}  // namespace

double stamp_evidence_nats(const Hypotheses& hypotheses) {
    return std::max(best_evidence_nats(hypotheses, true), 0.0);
}

std::optional<NullJudgement> judge_null(const Hypotheses& hypotheses, const NullSimulationOptions& options) {
    const std::optional<NullSimulations> null =
        simulate_null(hypotheses.prediction, &hypotheses.catalogue, options);
    if (!null) { return std::nullopt; }
    NullJudgement judgement;
    judgement.reference = gap_reference(null->curves);
    judgement.curves = gap_curves(*hypotheses.observation);
    const EvidenceTail effects(best_evidence_nats(*null));
    const double p_effects = effects.probability(best_evidence_nats(hypotheses, false));
    const double p_curves = EvidenceTail(simulated_surprises_nats(null->curves))
                                .probability(worst_surprise_nats(judgement.curves, judgement.reference));
    const double p_stamps = std::exp(-stamp_evidence_nats(hypotheses));
    // The smallest of three: exact where they are independent, a little cautious where they are not.
    const double least = std::min({p_effects, p_curves, p_stamps});
    judgement.p_none = -std::expm1(3.0 * std::log1p(-std::min(least, 1.0 - 1e-15)));
    judgement.evidence_min_nats = std::max(effects.threshold_nats(chance_of_an_effect), evidence_least_nats);
    judgement.floor_nats = mean_surprisal_nats(null->curves);
    judgement.excess_nats =
        sum_of(measure_surprises_nats(judgement.curves, judgement.reference)) - judgement.floor_nats;
    return judgement;
}

std::optional<Remainder> judge_remainder(const std::shared_ptr<const Prediction>& prediction,
                                         const Observation& observation, const RemainderOptions& options) {
    Remainder remainder;
    remainder.curves = gap_curves(observation);
    NullSimulationOptions simulations = options.simulations;
    if (!judge(remainder, prediction, simulations)) { return std::nullopt; }
    if (remainder.p >= options.doubted_below_p || remainder.p < options.doubted_above_p) { return remainder; }
    const bool moves = prediction->moves();
    simulations.simulations *= moves ? times_more_in_motion : times_more_in_doubt;
    simulations.purpose = RandomPurpose::simulations_in_doubt;
    simulations.measure_anew = moves && can_be_measured_anew(observation.recording());
    if (!judge(remainder, prediction, simulations)) { return std::nullopt; }
    return remainder;
}

}  // namespace gyrolog
