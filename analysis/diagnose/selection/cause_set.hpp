// The cause set holds the causes that a selection has so far, and says what they leave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/diagnose/calibration/null_bias.hpp"
#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/hypotheses.hpp"
#include "analysis/diagnose/report.hpp"
#include "analysis/diagnose/selection/joint_refit.hpp"

namespace gyrolog {

struct FoundCause {
    Finding finding;
    // The rivals are the findings of all effects with the other causes in the model, this one not.
    std::vector<Finding> rivals;
};

struct SelectionOptions {
    double evidence_min_nats = decisions.strong_nats;  // for a further cause
    // A share of the main cause's evidence: two right formulas of one filter differ by so much.
    double formulas_share = 5e-5;
    std::uint64_t seed = 1;
    unsigned threads = 0;
    std::function<bool(double)> on_progress{};  // false ends the work
};

class CauseSet {
public:
    // `first` is under the model as it was given, and outlives the set.
    CauseSet(const Hypotheses& first, std::shared_ptr<const Recording> recording,
             const SelectionOptions& options);

    std::vector<FoundCause> causes;
    SensorModel without_causes;
    NullBias null_bias;  // is taken off findings beside the main cause

    // What the causes leave, or all but one of them. Holes are filled as with all: noise of the model without
    // the cause would be fitted, too.
    Hypotheses with_causes() const;
    Hypotheses without(std::size_t left_out) const;
    // What the effect of one of them finds there, less bias.
    std::optional<Finding> found_again(std::size_t cause) const;
    Observation observed() const;
    SensorModel model_with_all_but(std::size_t left_out) const;

    // The cause with the most evidence, or that of the codes; null without causes.
    const Finding* main_cause() const;
    // Such a cause comes before all others, and stays.
    static bool is_of_codes(const Finding& finding);
    // A cause changes what others are judged by where right formulas of it may differ by half a nat.
    bool is_huge(double evidence_nats) const;
    // What a further cause must have.
    double evidence_least_nats() const;
    // Less what the main cause lets the finding seem to have.
    double evidence_less_bias_nats(const Finding& finding) const;

    // The findings, less bias, the best first.
    std::vector<Finding> findings_of(const std::vector<std::optional<Finding>>& found) const;
    // The best finding that is not of an effect found before: what those could explain, their fit has. Null
    // where none has evidence enough.
    const Finding* further(const std::vector<std::optional<Finding>>& found) const;
    // Of those, the best of each estimator, the best first.
    std::vector<Finding> all_further(const std::vector<std::optional<Finding>>& found) const;
    // The best of these, the best first: as many as are tried.
    static std::vector<Finding> best_first(std::map<EvidenceMethod, Finding> best);
    // Whether no cause tells what the finding does.
    bool is_new(const Finding& finding) const;
    // Whether a cause is another part of the same spectrum: a second one is not yet what its name says.
    bool is_told_by_twin(const Finding& finding) const;
    // An estimator of an effect that recurs gives its best, which may be what another such cause leaves: that
    // tells nothing of this one.
    bool is_of_another(const Finding& finding, std::size_t own) const;
    bool is_noise(const Finding& finding) const;
    // The place of the cause with the finding's effect and line; no value where there is none.
    std::optional<std::size_t> place_of(const Finding& finding) const;

    // The evidence that a cause needs to stay, and that of the same found again without it (may be null).
    double needed_nats(std::size_t cause) const;
    double own_nats(const Finding* again) const;
    // Of `found` without the cause, what does better in its place than `again`, the cause's own: it takes
    // over strongly more, and enough. What it has beside all causes is not the cause's to give. Null where
    // nothing does.
    const Finding* gives_way_to(std::size_t cause, const Finding* again, const std::vector<Finding>& found,
                                const Hypotheses& beside_all) const;
    // Of these findings, those that may stand in the cause's place.
    std::vector<Finding> rivals_of(const Finding& cause, const std::vector<Finding>& findings) const;
    // Of each estimator the best rival that is seen on axes of the cause, the best first; then rivals that
    // have fewer parameters than the cause and more evidence; then, on each axis of a cause of several, those
    // that explain that axis as well, to within strong evidence, with fewer parameters.
    std::vector<Finding> rivals_to_try(const FoundCause& cause) const;
    // The number of fitted parameters of these causes.
    static int parameters(const std::vector<FoundCause>& some);
    // Gives those axes to the rival. False where it takes none.
    bool give_to_rival(std::size_t place, const Finding& rival);

    // The worth is that of all measures: the spectra's likelihood, and what each cause gains beside them,
    // less the price of its freedom. What a cause explains in one measure and spoils in another counts
    // against it.
    double worth_nats(const Observation& with_causes) const;
    double worth_nats(const Hypotheses& with_causes, const Finding* next) const;
    double worth_beside_spectra_nats() const;
    static double worth_beside_spectra_nats(const Finding& finding);
    // The effects beside which the spectra's likelihood is another.
    static std::set<std::string> change_likelihood_among(const std::vector<FoundCause>& some);

    // Where the sensor moves: causes that shape the motion faster than it drifts, by place.
    std::vector<std::size_t> fast_responses() const;
    bool is_fast_response(const Finding& finding) const;
    // These and `more` (may be null) fitted together, with the other causes in the model.
    JointRefit fitted_together(const std::vector<std::size_t>& places, const Finding* more) const;
    // A response is fitted as if those that the model is uncertain of, the latency before all, stayed as they
    // are without it. Where it changes much of the motion they do not: all are fitted together. Whether
    // parameters moved.
    bool settle_responses();
    // Fits the noise spectra among the causes together.
    void settle_spectra();
    // Leaves the cause out where all measures, the other spectra fitted together without it, lose less than
    // strong evidence. `with_it_nats` is the worth with it. The function returns whether the cause is out.
    // Codes stay, and so does what changes the spectra's likelihood.
    bool leave_out_if_needless(std::size_t place, double with_it_nats);

private:
    static std::size_t parameters_on(const Finding& finding, std::size_t axis);
    bool may_give_way(const Finding& cause, const Finding& rival) const;
    std::vector<Finding> rivals_on_one_axis(const FoundCause& cause) const;
    double evidence_nats_of(const std::vector<std::size_t>& places) const;
    bool is_same(const Finding& a, const Finding& b) const;
    // The axes of the cause on which something of the rival is seen, less those that it has as a cause
    // already.
    std::vector<std::size_t> axes_to_give(const Finding& cause, const Finding& rival) const;
    // What is a cause already is no rival of another, unless on axes that it has not taken.
    bool is_rival(const Finding& finding, const Finding& cause) const;

    const Hypotheses& first_;
    std::shared_ptr<const Recording> recording_;
    SelectionOptions options_;
};

}  // namespace gyrolog
