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

double best_evidence_nats(const Hypotheses& hypotheses, bool in_stamps) {
    double best = resolution::no_evidence_nats;
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

std::vector<double> without(std::vector<double> values, std::size_t left_out) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(left_out));
    return values;
}

// How rarely the best effect or the worst curve is as far off, whichever is rarer: in nats.
class RarestOfTwo {
public:
    RarestOfTwo(std::vector<double> effects_nats, std::vector<double> curves_nats)
        : effects_(std::move(effects_nats)), curves_(std::move(curves_nats)) {}

    double nats(double effect_nats, double curve_nats) const {
        return std::max(effects_.surprise_nats(effect_nats), curves_.surprise_nats(curve_nats));
    }

private:
    EvidenceTail effects_;
    EvidenceTail curves_;
};

// Some simulations are enough for their mean.
double mean_surprisal_nats(const SimulatedCurves& simulations, std::size_t simulations_most) {
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

double probability_by_rank(double effect_nats, const std::vector<double>& effects_nats, double curve_nats,
                           const std::vector<double>& curves_nats) {
    std::vector<double> simulated_nats;
    for (std::size_t i = 0; i < effects_nats.size(); ++i) {
        const RarestOfTwo others(without(effects_nats, i), without(curves_nats, i));
        simulated_nats.push_back(others.nats(effects_nats[i], curves_nats[i]));
    }
    const RarestOfTwo all(effects_nats, curves_nats);
    return EvidenceTail(std::move(simulated_nats)).probability(all.nats(effect_nats, curve_nats));
}

double stamp_evidence_nats(const Hypotheses& hypotheses) {
    return std::max(best_evidence_nats(hypotheses, true), 0.0);
}

std::optional<NullJudgement> judge_null(const Hypotheses& hypotheses, const NullJudgementOptions& options) {
    const std::optional<NullSimulations> null =
        simulate_null(hypotheses.prediction, &hypotheses.catalogue, options.simulations);
    if (!null) { return std::nullopt; }
    NullJudgement judgement;
    judgement.reference = gap_reference(null->curves);
    judgement.curves = gap_curves(*hypotheses.observation);
    const std::vector<double> effects_nats = best_evidence_nats(*null);
    const double p = probability_by_rank(best_evidence_nats(hypotheses, false), effects_nats,
                                         worst_surprise_nats(judgement.curves, judgement.reference),
                                         simulated_surprises_nats(null->curves));
    const double p_stamps = std::exp(-stamp_evidence_nats(hypotheses));
    judgement.p_none =
        std::min({p / (1.0 - options.share_of_stamps), p_stamps / options.share_of_stamps, 1.0});
    judgement.evidence_min_nats = std::max(
        EvidenceTail(effects_nats).threshold_nats(options.chance_of_an_effect), options.evidence_least_nats);
    judgement.floor_nats = mean_surprisal_nats(null->curves, options.simulations_for_floor);
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
    simulations.simulations *= moves ? options.times_more_in_motion : options.times_more_at_rest;
    simulations.purpose = RandomPurpose::simulations_in_doubt;
    simulations.measure_anew = can_be_measured_anew(*prediction);
    if (!judge(remainder, prediction, simulations)) { return std::nullopt; }
    return remainder;
}

}  // namespace gyrolog
