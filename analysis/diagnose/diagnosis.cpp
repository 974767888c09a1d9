#include "analysis/diagnose/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>
#include <utility>

#include "analysis/diagnose/calibration/gap_domains.hpp"
#include "analysis/diagnose/calibration/gap_places.hpp"
#include "analysis/diagnose/calibration/half_fit.hpp"
#include "analysis/diagnose/calibration/measured_gap.hpp"
#include "analysis/diagnose/calibration/null_judgement.hpp"
#include "analysis/diagnose/calibration/own_start.hpp"
#include "analysis/diagnose/calibration/parametric_bootstrap.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/measures/unreferenced_motion.hpp"
#include "analysis/diagnose/selection/asked_effect.hpp"
#include "analysis/diagnose/selection/better_shape.hpp"
#include "analysis/diagnose/selection/cause_probability.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "analysis/diagnose/selection/unnamed_forms.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog::resolution {

// What a simulation and its observation hold at once.
constexpr double bytes_per_sample_and_thread = 160.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

unsigned affordable_threads(std::size_t samples, double bytes_most) {
    const double each = resolution::bytes_per_sample_and_thread * static_cast<double>(samples);
    const double affordable = std::max(1.0, bytes_most / each);
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    return affordable < processors ? static_cast<unsigned>(affordable) : processors;
}

// The steps, in their order: predict, look for effects, judge the null, select causes, judge what they leave
// and measure how far each closes the gap, leave out those that close nothing, decide, report.
class Diagnoser {
public:
    Diagnoser(std::shared_ptr<const Recording> recording, const SensorModel& model,
              const DiagnosisOptions& options)
        : recording_(std::move(recording)), options_(options), answer_() {
        const auto world = std::make_shared<const RecordedWorld>(recording_);
        OwnStart start = with_own_start(std::make_shared<const Prediction>(world, model, options_.noise_of),
                                        recording_, options_.seed);
        prediction_ = std::move(start.prediction);
        faint_lines_hz_ = std::move(start.faint_lines_hz);
        answer_.warnings = world->warnings();
        append_new(answer_.warnings, start.warnings);
        if (options_.threads == 0) {
            options_.threads = affordable_threads(prediction_->length(), options_.simulations_bytes_most);
        }
    }

    std::optional<Diagnosis> run(const std::string& model_name) {
        describe(model_name);
        if (!told("looking for effects", 0.0)) { return std::nullopt; }
        const Hypotheses first = examine(prediction_, recording_, options_.seed, options_.threads);
        describe_tests(first);
        NullJudgementOptions judging;
        judging.simulations = simulation_options(options_.simulations, RandomPurpose::null_simulations);
        judging.simulations.on_progress = progress("simulating the model", 0.1, 0.5);
        std::optional<NullJudgement> null = judge_null(first, judging);
        if (!null) { return std::nullopt; }
        null_ = *std::move(null);
        answer_.p_none = null_.p_none;
        describe_gap_of_null();
        answer_.corrected = found_.corrected = prediction_->model();
        const bool has_gap = answer_.p_none < options_.false_alarms_most;
        if (has_gap && (!select(first) || !measure(first))) { return std::nullopt; }
        // A second recording has its say of a model without causes, too.
        if (options_.holdout && !measured_ && !measure_causes(first)) { return std::nullopt; }
        describe_measured_gap();
        describe_places();
        if (has_gap) { decide(); }
        if (!widen_uncertainties()) { return std::nullopt; }
        answer_questions();
        return std::move(answer_);
    }

private:
    bool told(const char* what, double share) const {
        return !options_.on_progress || options_.on_progress(what, share);
    }

    std::function<bool(double)> progress(const char* what, double from, double share) const {
        return [=, this](double of_step) { return told(what, from + share * of_step); };
    }

    NullSimulationOptions simulation_options(std::size_t simulations, RandomPurpose purpose) const {
        NullSimulationOptions options;
        options.simulations = simulations;
        options.seed = options_.seed;
        options.purpose = purpose;
        options.threads = options_.threads;
        return options;
    }

    void describe(const std::string& model_name) {
        answer_.recording_name = recording_->name;
        answer_.model_name = model_name;
        answer_.rate_hz = recording_->rate_hz;
        answer_.duration_s = recording_->duration_s();
        answer_.samples = recording_->rows();
        answer_.simulations = options_.simulations;
        answer_.seed = options_.seed;
        answer_.axes = prediction_->axes();
    }

    // Where nothing is found that could close it.
    void describe_gap_of_null() {
        answer_.floor_nats = null_.floor_nats;
        answer_.excess_nats = std::max(null_.excess_nats, 0.0);
        const double value = std::sqrt(1.0 + std::max(null_.excess_nats / null_.floor_nats, -1.0));
        answer_.gap_before = answer_.gap_named = answer_.gap_after = {value, 1.0, value, value};
    }

    void describe_tests(const Hypotheses& first) {
        for (const CatalogueEntry& entry : first.catalogue) {
            if (entry.untestable.empty()) { continue; }
            answer_.untestable.push_back({std::string(entry.effect->name), entry.untestable});
        }
        if (!seems_to_have_turned(*first.observation)) { return; }
        answer_.warnings.emplace_back(
            "the samples stray far more than noise does: the sensor seems to have been turned, and without "
            "a reference rate (columns ref_x_dps ... or ref_qw ...) nothing of that can be judged; use a "
            "part at rest");
    }

    SelectionOptions selection_options() const {
        SelectionOptions options;
        options.evidence_min_nats = null_.evidence_min_nats;
        options.seed = options_.seed;
        options.threads = options_.threads;
        options.on_progress = progress("looking for causes", 0.6, 0.1);
        return options;
    }

    bool take(std::optional<CauseSelection> found) {
        if (!found) { return false; }
        found_ = *std::move(found);
        found_.corrected = with_mean_of(*found_.last.observation, std::move(found_.corrected));
        return true;
    }

    bool select(const Hypotheses& first) {
        return take(select_causes(first, recording_, selection_options()));
    }

    // Without the causes and forms that close nothing on data that the fit did not use, one after the other;
    // and no corrected model is farther from them than the first.
    bool measure(const Hypotheses& first) {
        if (!judge_what_is_left()) { return false; }
        model_what_is_left(first);
        while (!found_.causes.empty() || !unnamed_.empty()) {
            if (!measure_causes(first)) { return false; }
            const std::optional<std::size_t> place = needless();
            if (!place) { break; }
            if (*place >= found_.causes.size()) {
                unnamed_.erase(unnamed_.begin() + static_cast<std::ptrdiff_t>(*place - found_.causes.size()));
                continue;
            }
            if (!leave_out(*place, first) || !judge_what_is_left()) { return false; }
            model_what_is_left(first);
        }
        answer_.corrected = found_.corrected;
        answer_.noise_refits = found_.noise_refits;
        return unnamed_.empty() || judge_what_forms_leave();
    }

    // Of the causes, then the forms: one without which the gap is no larger. What is counted was not fitted.
    std::optional<std::size_t> needless() const {
        const std::size_t causes = found_.causes.size();
        const std::vector<double>& nats = measured_->returning_nats;
        const auto least_of = [&](std::size_t from, std::size_t to) {
            std::optional<std::size_t> least;
            for (std::size_t i = from; i < to; ++i) {
                if (i < causes && traits_of(found_.causes[i].finding.effect).is_counted) { continue; }
                if (!least || nats[i] < nats[*least]) { least = i; }
            }
            return least;
        };
        const std::optional<std::size_t> least = least_of(0, nats.size());
        if (!least || nats[*least] <= 0.0) { return least; }
        if (measured_->named.value > measured_->before.value) { return least_of(0, causes); }
        const bool forms_harm = measured_->after.value > measured_->named.value;
        return forms_harm ? least_of(causes, nats.size()) : std::nullopt;
    }

    // A sensor that was turned and whose reference nobody knows leaves its motion.
    void model_what_is_left(const Hypotheses& first) {
        unnamed_.clear();
        if (answer_.p_left >= left_from_p() || seems_to_have_turned(*first.observation)) { return; }
        unnamed_ = unnamed_forms(prediction_->with(found_.corrected), recording_, options_.seed);
    }

    bool judge_what_forms_leave() {
        SensorModel model = found_.corrected;
        for (const Finding& form : unnamed_) { model = with_cause(std::move(model), form); }
        after_forms_ = remainder_of(model);
        return after_forms_.has_value();
    }

    bool judge_what_is_left() {
        if (found_.causes.empty()) {
            remainder_.reset();
            answer_.p_left = answer_.p_none;
            return true;
        }
        remainder_ = remainder_of(found_.corrected);
        if (remainder_) { answer_.p_left = remainder_->p; }
        return remainder_.has_value();
    }

    std::optional<Remainder> remainder_of(const SensorModel& model) const {
        RemainderOptions options;
        options.simulations =
            simulation_options(std::min(options_.simulations, options_.simulations_after_most),
                               RandomPurpose::simulations_after);
        options.simulations.on_progress = progress("simulating the corrected model", 0.7, 0.1);
        options.doubted_below_p = left_from_p();
        const auto prediction = prediction_->with(model);
        return judge_remainder(prediction, Observation(prediction, recording_, options_.seed), options);
    }

    // What causes leave is by chance where its probability is more.
    double left_from_p() const { return 0.5 * options_.false_alarms_most; }

    bool measure_causes(const Hypotheses& first) {
        GapTrial trial = options_.holdout ? trial_on_holdout() : trial_on_halves();
        if (!options_.holdout) {
            trial.stamps_before_nats = stamp_evidence_nats(first);
            trial.stamps_named_nats = stamp_evidence_nats(found_.last);
        }
        MeasuredGapOptions options;
        options.simulations = std::min(options_.simulations, options.simulations);
        options.paired_simulations = std::min(options_.simulations, options.paired_simulations);
        options.seed = options_.seed;
        options.threads = options_.threads;
        options.on_progress = progress("measuring how far each cause closes the gap", 0.8, 0.1);
        std::optional<MeasuredGap> measured = measure_gap(trial, options);
        if (!measured) { return false; }
        measured_ = std::move(measured);
        // What happened in the first recording alone the second does not judge: the fit speaks for it.
        for (std::size_t i = 0; options_.holdout && i < found_.causes.size(); ++i) {
            const Finding& finding = found_.causes[i].finding;
            if (is_event(finding)) { measured_->returning_nats[i] = finding.evidence_nats; }
        }
        return true;
    }

    static bool is_event(const Finding& finding) { return find_effect(finding.effect)->signature->event; }

    std::vector<Finding> findings() const {
        std::vector<Finding> causes;
        for (const FoundCause& found : found_.causes) { causes.push_back(found.finding); }
        return causes;
    }

    std::vector<Finding> findings_and_forms() const {
        std::vector<Finding> all = findings();
        all.insert(all.end(), unnamed_.begin(), unnamed_.end());
        return all;
    }

    // The corrected model less its causes, which were added last.
    static SensorModel without_causes(SensorModel corrected, const std::vector<Finding>& causes) {
        std::size_t entries = 0;
        for (const Finding& cause : causes) { entries += cause.entries.size(); }
        corrected.effects.resize(corrected.effects.size() - entries);
        return corrected;
    }

    GapTrial trial_on_halves() {
        GapTrial trial{recording_, {}, {}, findings_and_forms(), 0.0, 0.0, unnamed_.size()};
        trial.without_causes = without_causes(found_.corrected, findings());
        answer_.not_held_out.clear();
        for (const Finding& cause : findings()) {
            if (!can_be_halved(cause.effect, *prediction_)) {
                append_new(answer_.not_held_out, {cause.effect});
            }
        }
        const auto base = prediction_->with(found_.without_causes);
        for (const auto& [fitted, judging] :
             {std::pair(Half::first, Half::second), std::pair(Half::second, Half::first)}) {
            trial.folds.push_back(
                {prediction_->of_half(judging),
                 fitted_to_half(base->of_half(fitted), recording_, trial.causes, options_.seed)});
        }
        return trial;
    }

    // What happened at one time of the first recording did not happen in the second.
    GapTrial trial_on_holdout() {
        answer_.held_out = options_.holdout->name;
        GapTrial trial{options_.holdout, {}, {}, findings_and_forms(), 0.0, 0.0, unnamed_.size()};
        std::vector<std::optional<Finding>> lasting;
        for (Finding& cause : trial.causes) {
            const bool is_gone = is_event(cause);
            if (is_gone) {
                append_new(answer_.warnings, {cause.effect + " happened in the first recording: the second "
                                                             "is judged without it"});
                cause.entries.clear();
                cause.sd.clear();
            }
            lasting.push_back(is_gone ? std::nullopt : std::optional(cause));
        }
        const auto world = std::make_shared<const RecordedWorld>(options_.holdout);
        const auto given = prediction_->in_world(world, prediction_->model());
        SensorModel corrected = without_causes(found_.corrected, findings());
        for (const auto& cause : lasting) {
            if (cause) { corrected = with_cause(std::move(corrected), *cause); }
        }
        const auto named = with_own_start(given->with(corrected), options_.holdout, options_.seed);
        trial.without_causes = without_causes(named.prediction->model(), trial.causes);
        trial.folds.push_back(
            {with_own_start(given, options_.holdout, options_.seed).prediction, std::move(lasting)});
        return trial;
    }

    bool leave_out(std::size_t cause, const Hypotheses& first) {
        append_new(answer_.warnings, {found_.causes[cause].finding.effect +
                                      " is left out: on data that the fit did not use the "
                                      "gap is no smaller with it"});
        return take(without_cause(std::move(found_), cause, first, recording_, selection_options()));
    }

    void describe_places() {
        answer_.where = farthest_place(null_.curves, null_.reference);
        const JudgedCurves before{null_.curves, null_.reference};
        const JudgedCurves after = last_curves();
        answer_.domains = gap_domains(before, remainder_ ? &after : nullptr, answer_.band_probability);
    }

    // Of the corrected model where there is one.
    JudgedCurves last_curves() const {
        return remainder_ ? JudgedCurves{remainder_->curves, remainder_->reference}
                          : JudgedCurves{null_.curves, null_.reference};
    }

    void decide() {
        const JudgedCurves last = last_curves();
        const std::optional<Remainder>& left = after_forms_;
        answer_.left = left ? places_that_stand_out(left->curves, left->reference)
                            : places_that_stand_out(last.curves, last.reference);
        if (prediction_->noise_is_sensors()) {
            answer_.better_shape = better_shape(found_, prediction_, recording_,
                                                {.seed = options_.seed, .threads = options_.threads});
        }
        for (std::size_t i = 0; i < found_.causes.size(); ++i) {
            Cause cause = with_probability(found_.causes[i], found_, measured_->returning_nats[i],
                                           answer_.better_shape);
            cause.share = measured_->shares[i];
            cause.sense = sense_of(cause.finding);
            answer_.causes.push_back(std::move(cause));
        }
        for (std::size_t i = 0; i < unnamed_.size(); ++i) {
            answer_.unnamed.push_back(unnamed_of(unnamed_[i], measured_->shares[found_.causes.size() + i]));
        }
        std::ranges::stable_sort(answer_.causes, std::greater{},
                                 [](const Cause& cause) { return cause.share.value; });
        answer_.verdict = verdict_of(answer_.causes, answer_.p_left >= left_from_p(), answer_.shrink.value);
        if (answer_.verdict == Verdict::known) { answer_.where = answer_.causes.front().finding.where; }
        propose_recordings();
    }

    // That is the first model's where every cause was left out.
    void describe_measured_gap() {
        if (!measured_) { return; }
        answer_.gap_before = measured_->judged;
        answer_.gap_named = found_.causes.empty() ? measured_->judged : measured_->named;
        answer_.gap_after = unnamed_.empty() ? answer_.gap_named : measured_->after;
        answer_.floor_nats = measured_->floor_nats;
        answer_.excess_nats = measured_->excess_nats;
        if (!found_.causes.empty()) { answer_.shrink = measured_->shrink; }
        answer_.shrink_modelled = unnamed_.empty() ? answer_.shrink.value : measured_->shrink_modelled.value;
    }

    // A line at the place of one that the model has, and the recording has not, takes it off.
    Sense sense_of(const Finding& finding) const {
        if (!finding.where.freq_hz || !traits_of(finding.effect).is_line) { return Sense::recording_has; }
        const bool takes_off = std::ranges::any_of(faint_lines_hz_, [&](double f_hz) {
            return finding.where.freq_hz->from <= f_hz && f_hz <= finding.where.freq_hz->to;
        });
        return takes_off ? Sense::model_has : Sense::recording_has;
    }

    // What would settle what is open.
    void propose_recordings() {
        for (Cause& cause : answer_.causes) {
            state_deciding_length(cause, prediction_->duration_s());
            std::string proposal = deciding_recording(cause);
            if (!proposal.empty()) { answer_.next_recordings.push_back(std::move(proposal)); }
        }
        if (answer_.verdict == Verdict::known) { return; }
        answer_.next_recordings.emplace_back(
            "what is not explained: a second recording under the same conditions tells whether it comes back "
            "at the same place, and one under others (temperature, supply, mounting, sample rate) what it "
            "depends on");
    }

    bool widen_uncertainties() {
        if (answer_.causes.empty()) { return true; }
        BootstrapOptions options{.seed = options_.seed, .threads = options_.threads};
        options.on_progress = progress("looking how well the parameters are known", 0.9, 0.1);
        std::vector<Finding> causes;
        for (const Cause& cause : answer_.causes) { causes.push_back(cause.finding); }
        std::optional<std::vector<Finding>> known = with_bootstrap_sd(
            prediction_->with(found_.without_causes), answer_.corrected, std::move(causes), options);
        if (!known) { return false; }
        for (std::size_t i = 0; i < known->size(); ++i) {
            answer_.causes[i].finding = std::move((*known)[i]);
        }
        return true;
    }

    void answer_questions() {
        if (options_.asked.empty()) { return; }
        const Observation alone(prediction_, recording_, options_.seed);
        const Observation beside = alone.under(answer_.corrected);
        for (const DescribedEffect& described : options_.asked) {
            answer_.asked.push_back(asked(described, beside, alone));
        }
    }

    std::shared_ptr<const Recording> recording_;
    DiagnosisOptions options_;
    std::shared_ptr<const Prediction> prediction_;
    std::vector<double> faint_lines_hz_;
    Diagnosis answer_;
    NullJudgement null_;
    CauseSelection found_;
    std::vector<Finding> unnamed_;
    std::optional<Remainder> remainder_;    // of the causes
    std::optional<Remainder> after_forms_;  // of the forms without a name
    std::optional<MeasuredGap> measured_;
};

}  // namespace

void append_new(std::vector<std::string>& to, const std::vector<std::string>& from) {
    for (const std::string& sentence : from) {
        if (std::ranges::count(to, sentence) == 0) { to.push_back(sentence); }
    }
}

std::optional<Diagnosis> diagnose(std::shared_ptr<const Recording> recording, const SensorModel& model,
                                  const std::string& model_name, const DiagnosisOptions& options) {
    return Diagnoser(std::move(recording), model, options).run(model_name);
}

}  // namespace gyrolog
