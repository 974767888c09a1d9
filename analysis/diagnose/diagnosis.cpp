#include "analysis/diagnose/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>
#include <span>
#include <thread>

#include "analysis/diagnose/calibration/cause_shares.hpp"
#include "analysis/diagnose/calibration/evidence_tail.hpp"
#include "analysis/diagnose/calibration/gap_domains.hpp"
#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/calibration/gap_summary.hpp"
#include "analysis/diagnose/calibration/null_simulations.hpp"
#include "analysis/diagnose/calibration/parametric_bootstrap.hpp"
#include "analysis/diagnose/calibration/replicates.hpp"
#include "analysis/diagnose/calibration/split_half_validation.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/noise_refit.hpp"
#include "analysis/diagnose/likelihood/observed_line.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "analysis/diagnose/selection/nonparametric_alternatives.hpp"
#include "analysis/numerics/distributions.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

namespace {

// What the causes leave is called unexplained where chance leaves it in fewer than so many of the recordings
// in which chance has a gap,
constexpr double unexplained_share = 0.5;
// unless it is so little of the gap, 4 % of its size, that the approximations of a fit may leave it, and
// chance nearly.
constexpr double tolerated_share = 1.6e-3;
constexpr double tolerated_above_p = 1e-6;
// A shape of no known origin takes the place of causes that it beats by this,
constexpr double shape_wins_nats = 8.0;
// and by this share of their gain: the approximations of a fit may lose as much.
constexpr double shape_wins_share = 0.04;
// As many effects together fit anything.
constexpr std::size_t many_effects = 5;
// How often a cause is right that does not explain the gap: something else is there that it may stand for.
constexpr double part_of_unexplained = 0.2;
constexpr double tie_nats = 4.0;
constexpr std::size_t tie_most = 4;
// A difference of this evidence is no tie any more, whatever chance does to it.
constexpr double decided_nats = 8.0;
constexpr std::size_t simulations_after_most = 50;
// Their tail, of five, is known to half of its length. Where it says that chance hardly leaves so much, but
// might, so many times more are asked; of what moves fewer, each measured anew.
constexpr std::size_t times_more_in_doubt = 4;
constexpr std::size_t times_more_in_motion = 2;
constexpr double faint_line_share = 0.5;
// Of the Allan variance at a second, which is the white noise's density: none is thirty times as strong
// as its model.
constexpr double square_of_motion = 1000.0;

// What a simulation and its observation hold at once.
constexpr double bytes_per_sample_and_thread = 160.0;

unsigned affordable_threads(std::size_t samples, double bytes_most) {
    const double each = bytes_per_sample_and_thread * static_cast<double>(samples);
    const double affordable = std::max(1.0, bytes_most / each);
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    return affordable < processors ? static_cast<unsigned>(affordable) : processors;
}

bool are_alike(const GapCurve& a, const GapCurve& b) {
    return a.measure == b.measure && a.axis == b.axis && a.other == b.other &&
           a.value.size() == b.value.size();
}

class Diagnoser {
public:
    Diagnoser(std::shared_ptr<const Recording> recording, const SensorModel& model,
              const DiagnosisOptions& options)
        : recording_(std::move(recording)), options_(options), answer_() {
        const auto world = std::make_shared<const RecordedWorld>(recording_);
        answer_.warnings = world->warnings();
        prediction_ = with_own_start(std::make_shared<const Prediction>(world, model), recording_);
        if (options_.threads == 0) {
            options_.threads = affordable_threads(prediction_->length(), options_.simulations_bytes_most);
        }
    }

    std::optional<Diagnosis> run(const std::string& model_name) {
        describe(model_name);
        if (!told("looking for effects", 0.0)) { return std::nullopt; }
        first_ = examine(prediction_, recording_, options_.seed, options_.threads);
        warn_of_motion();
        for (const CatalogueEntry& entry : first_.catalogue) {
            if (!entry.untestable.empty()) {
                answer_.untestable.push_back({std::string(entry.effect->name), entry.untestable});
            }
        }
        if (!simulate_before() || !search() || !simulate_after()) { return std::nullopt; }
        withdraw_harmful_causes();
        if (found_) { compare_shapes(); }
        decide();
        if (!widen_uncertainties()) { return std::nullopt; }
        if (options_.holdout && !measure_on_holdout()) { return std::nullopt; }
        return std::move(answer_);
    }

private:
    bool told(const char* what, double share) const {
        return !options_.on_progress || options_.on_progress(what, share);
    }

    // A turn-on bias is free; where the output clips, and where it lies between two codes, it matters. So is
    // the phase that a line had at the first sample.
    std::shared_ptr<const Prediction> with_own_start(const std::shared_ptr<const Prediction>& prediction,
                                                     const std::shared_ptr<const Recording>& recording) {
        SensorModel model = prediction->model();
        for (EffectModel& entry : model.effects) {
            if (!traits_of(entry.effect).is_line) { continue; }
            const ObservedLine seen = observe_line(*prediction, recording, entry, options_.seed);
            entry.params["phase_rad"] = seen.phase_rad;
            if (recording == recording_ && seen.share < faint_line_share) { warn_of_faint(entry, seen); }
        }
        const Observation observation(prediction->with(model), recording, options_.seed);
        return prediction->with(with_mean_of(observation, std::move(model)));
    }

    // The bias that leaves nothing of the observation's mean.
    static SensorModel with_mean_of(const Observation& observation, SensorModel model) {
        for (const std::size_t axis : observation.prediction().axes()) {
            model.axes[axis].bias_rad_s += observation.axis(axis).mean_rad_s;
        }
        return model;
    }

    void warn_of_faint(const EffectModel& line, const ObservedLine& seen) {
        const EffectValues values(line);
        std::array<char, 160> text{};
        (void)std::snprintf(text.data(), text.size(),
                            "the model's %s at %.5g Hz has %.0f %% of its amplitude in the recording: one at "
                            "that frequency among the causes takes it off again",
                            line.effect.c_str(), values["f_hz"], 100.0 * seen.share);
        answer_.warnings.emplace_back(text.data());
    }

    // Allan variance at a second: no drift is so fast, no vibration so slow.
    double second_to_second_variance(std::size_t axis) const {
        const std::vector<float>& residual = first_.observation->axis(axis).residual_rad_s;
        const auto second = static_cast<std::size_t>(std::max(1.0, std::round(prediction_->rate_hz())));
        double before = 0.0;
        double squares = 0.0;
        std::size_t seconds = 0;
        for (; (seconds + 1) * second <= residual.size(); ++seconds) {
            const auto from = residual.begin() + static_cast<std::ptrdiff_t>(seconds * second);
            const double mean = std::accumulate(from, from + static_cast<std::ptrdiff_t>(second), 0.0) /
                                static_cast<double>(second);
            if (seconds > 0) { squares += 0.5 * (mean - before) * (mean - before); }
            before = mean;
        }
        return seconds > 1 ? squares / static_cast<double>(seconds - 1) : 0.0;
    }

    // Without a reference, what turned is all noise.
    void warn_of_motion() {
        if (prediction_->moves()) { return; }
        for (const std::size_t axis : prediction_->axes()) {
            const double white = prediction_->parts(axis).back().sum();
            if (!(second_to_second_variance(axis) > square_of_motion * white)) { continue; }
            answer_.warnings.emplace_back(
                "the rates stray far more than noise does: the sensor seems to have been turned, and without "
                "a reference rate (columns ref_x_dps ... or ref_qw ...) nothing of that can be judged; use a "
                "part at rest");
            return;
        }
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
        answer_.held_out = "";
    }

    NullSimulationOptions simulation_options(std::size_t simulations, RandomPurpose purpose) const {
        NullSimulationOptions options;
        options.simulations = simulations;
        options.seed = options_.seed;
        options.purpose = purpose;
        options.threads = options_.threads;
        return options;
    }

    bool simulate_before() {
        NullSimulationOptions options =
            simulation_options(options_.simulations, RandomPurpose::null_simulations);
        options.on_progress = [&](double share) { return told("simulating the model", 0.1 + 0.5 * share); };
        std::optional<NullSimulations> null = simulate_null(prediction_, &first_.catalogue, options);
        if (!null) { return false; }
        before_ = gap_reference(null->curves);
        evidence_tail_.emplace(best_evidence_nats(*null));
        surprise_tail_.emplace(simulated_surprises_nats(null->curves));
        const std::vector<GapCurve> curves = gap_curves(*first_.observation);
        answer_.p_none = probability_of_none(curves);
        before_curves_ = curves;
        return true;
    }

    // Of the best effect, the worst curve and the stamps: three scans, each with its own chance.
    double probability_of_none(const std::vector<GapCurve>& curves) const {
        double evidence = -50.0;
        double stamps = 0.0;
        for (const std::optional<Finding>& finding : first_.findings) {
            if (!finding) { continue; }
            double& best = traits_of(finding->effect).is_in_stamps ? stamps : evidence;
            best = std::max(best, finding->evidence_nats);
        }
        const double p_effects = evidence_tail_->probability(evidence);
        const double p_curves = surprise_tail_->probability(worst_surprise_nats(curves, before_));
        const double p_stamps = std::exp(-stamps);
        // The smallest of three: exact where they are independent, a little cautious where they are not.
        const double least = std::min({p_effects, p_curves, p_stamps});
        return -std::expm1(3.0 * std::log1p(-std::min(least, 1.0 - 1e-15)));
    }

    bool search() {
        SelectionOptions options;
        // A single effect, in one recording of two hundred by chance.
        options.evidence_min_nats = std::max(evidence_tail_->threshold_nats(0.005), 3.0);
        options.seed = options_.seed;
        options.threads = options_.threads;
        options.on_progress = [&](double share) { return told("looking for causes", 0.6 + 0.2 * share); };
        if (answer_.p_none >= options_.false_alarms_most) {
            answer_.corrected = prediction_->model();
            return true;
        }
        std::optional<CauseSelection> result = select_causes(first_, recording_, options);
        if (!result) { return false; }
        // Causes have means, too.
        answer_.corrected = with_mean_of(*result->last.observation, std::move(result->corrected));
        answer_.noise_refits = result->noise_refits;
        found_ = std::move(*result);
        return true;
    }

    bool simulate_after() {
        if (!found_ || found_->causes.empty()) { return true; }
        after_curves_ = gap_curves(*found_->last.observation);
        NullSimulationOptions options = simulation_options(
            std::min(options_.simulations, simulations_after_most), RandomPurpose::simulations_after);
        if (!judge_what_is_left(options)) { return false; }
        if (answer_.p_left >= unexplained_below_p() || answer_.p_left < tolerated_above_p) { return true; }
        const bool moves = prediction_->moves();
        options.simulations *= moves ? times_more_in_motion : times_more_in_doubt;
        options.purpose = RandomPurpose::simulations_in_doubt;
        options.measure_anew = moves && can_be_measured_anew(*recording_);
        return judge_what_is_left(options);
    }

    double unexplained_below_p() const { return unexplained_share * options_.false_alarms_most; }

    bool judge_what_is_left(NullSimulationOptions options) {
        options.on_progress = [&](double share) {
            return told("simulating the corrected model", 0.8 + 0.2 * share);
        };
        std::optional<NullSimulations> null =
            simulate_null(found_->last.prediction->with(answer_.corrected), nullptr, options);
        if (!null) { return false; }
        // An axis at rest may seem to move where it is measured anew, and has other curves then.
        std::erase_if(null->curves, [&](const std::vector<GapCurve>& curves) {
            return !std::ranges::equal(curves, after_curves_, are_alike);
        });
        if (null->curves.size() < options.simulations / 2) { return true; }
        after_ = gap_reference(null->curves);
        surprise_left_nats_ = worst_surprise_nats(after_curves_, *after_);
        answer_.p_left =
            EvidenceTail(simulated_surprises_nats(null->curves)).probability(surprise_left_nats_);
        return true;
    }

    // Causes with which the model is farther from the recording than it was explain nothing.
    void withdraw_harmful_causes() {
        if (!after_ || answer_.p_left >= unexplained_below_p()) { return; }
        const double before = summarise(before_curves_, before_).gap.value;
        const double after = summarise(after_curves_, *after_).gap.value;
        if (after <= before) { return; }
        std::vector<std::string> effects;
        for (const FoundCause& cause : found_->causes) { append_new(effects, {cause.finding.effect}); }
        std::string text = "left out, since the gap would be ";
        std::array<char, 60> gaps{};
        (void)std::snprintf(gaps.data(), gaps.size(), "%.3g instead of %.3g with", after, before);
        text += gaps.data();
        for (const std::string& effect : effects) {
            text += (effect == effects.front() ? " " : ", ") + effect;
        }
        answer_.warnings.push_back(std::move(text));
        found_->causes.clear();
        found_->without_causes = answer_.corrected = prediction_->model();
        answer_.noise_refits.clear();
        answer_.p_left = 1.0;
        after_.reset();
        after_curves_.clear();
    }

    Observation without(std::span<const FoundCause> left_out) const {
        SensorModel model = found_->without_causes;
        for (const FoundCause& cause : found_->causes) {
            const bool is_left_out =
                std::ranges::any_of(left_out, [&](const FoundCause& one) { return &one == &cause; });
            if (!is_left_out) { model = with_cause(std::move(model), cause.finding); }
        }
        return {prediction_->with(model), recording_, options_.seed};
    }

    struct Worth {
        double gain_nats = 0.0;
        double evidence_nats = 0.0;
    };

    // `together_nats`: what the spectra's likelihood gains by all of them. One fitted beside others may have
    // little that is its own, and much with them; what tails or codes gain is not in the spectra.
    Worth worth_of(std::span<const FoundCause> causes, double together_nats) const {
        Worth worth;
        for (const FoundCause& cause : causes) {
            worth.gain_nats += cause.finding.gain_nats;
            worth.evidence_nats += cause.finding.evidence_nats;
            worth.evidence_nats += found_->null_bias.of(cause.finding);
        }
        const double cost_nats = worth.gain_nats - worth.evidence_nats;
        if (causes.size() > 1 && together_nats > worth.gain_nats) {
            worth = {together_nats, together_nats - cost_nats};
        }
        return worth;
    }

    // In place of every cause, and of all of them.
    void compare_shapes() {
        const std::span<const FoundCause> all = found_->causes;
        std::vector<std::span<const FoundCause>> places;
        for (std::size_t i = 0; i < all.size(); ++i) { places.push_back(all.subspan(i, 1)); }
        if (all.size() != 1) { places.push_back(all); }
        const Observation with = without({});
        std::vector<std::optional<BetterShape>> better(places.size());
        parallel_for(places.size(), options_.threads, [&](std::size_t i) {
            const Observation left = without(places[i]);
            const std::optional<NonparametricFit> shape = best_nonparametric(left, with);
            if (!shape) { return; }
            const double together_nats = log_likelihood_nats(with) - log_likelihood_nats(left);
            const Worth causes = worth_of(places[i], together_nats);
            const double more_nats = shape->evidence_nats - causes.evidence_nats;
            if (more_nats < std::max(shape_wins_nats, shape_wins_share * causes.gain_nats)) { return; }
            std::vector<std::string> than;
            for (const FoundCause& cause : places[i]) { than.push_back(cause.finding.effect); }
            better[i] = BetterShape{shape->words, std::move(than), more_nats};
        });
        for (std::optional<BetterShape>& one : better) {
            if (!one) { continue; }
            if (!answer_.better_shape || one->evidence_nats > answer_.better_shape->evidence_nats) {
                answer_.better_shape = std::move(one);
            }
        }
    }

    void describe_domains() {
        const MeasuredGap before{before_curves_, before_};
        if (!after_) {
            answer_.domains = gap_domains(before, nullptr, answer_.band_probability);
            return;
        }
        const MeasuredGap after{after_curves_, *after_};
        answer_.domains = gap_domains(before, &after, answer_.band_probability);
    }

    void decide() {
        const GapSummary before = summarise(before_curves_, before_);
        const GapSummary after = after_ ? summarise(after_curves_, *after_) : before;
        answer_.gap_before = before.gap;
        answer_.gap_after = after.gap;
        describe_domains();
        if (answer_.p_none >= options_.false_alarms_most) {
            answer_.verdict = Verdict::none;
            return;
        }
        const double excess_before = before.gap.value * before.gap.value - 1.0;
        const double excess_after = std::max(after.gap.value * after.gap.value - 1.0, 0.0);
        const bool next_to_chance =
            answer_.p_left >= tolerated_above_p || surprise_left_nats_ < formulas_share * found_gain_nats();
        const bool tolerable = excess_after < tolerated_share * excess_before && next_to_chance;
        const bool explained = after_ && !answer_.better_shape && effects_found() < many_effects &&
                               (answer_.p_left >= unexplained_below_p() || tolerable);
        answer_.verdict = explained ? Verdict::known : Verdict::unexplained;
        if (found_) {
            for (const FoundCause& found : found_->causes) {
                answer_.causes.push_back(cause_of(found, explained));
            }
        }
        if (explained) {
            validate_halves();
            close_by_causes();
        } else {
            const double shrink = excess_before > 0.0 ? 1.0 - excess_after / excess_before : 0.0;
            // What is not right may look right where it was fitted, and close nothing.
            answer_.shrink = answer_.shrink_hi = std::clamp(shrink, 0.0, 1.0);
            answer_.shrink_lo = 0.0;
        }
        share_among_causes(answer_);
        propose_recordings();
        answer_.where = explained ? answer_.causes.front().finding.where : before.where;
        if (!explained && after_ && !answer_.better_shape) { answer_.left = after.where; }
    }

    double found_gain_nats() const {
        double sum = 0.0;
        for (const FoundCause& cause : found_->causes) { sum += cause.finding.gain_nats; }
        return sum;
    }

    std::size_t effects_found() const {
        std::set<std::string> effects;
        for (const FoundCause& cause : found_->causes) { effects.insert(cause.finding.effect); }
        return effects.size();
    }

    // What would settle what is open.
    void propose_recordings() {
        for (const Cause& cause : answer_.causes) {
            if (cause.decided_by.empty()) { continue; }
            const Rival& rival = cause.tie_group[1];
            std::string proposal =
                telling_apart(cause.finding.effect) + rival.effect + ": " + cause.decided_by;
            // What noise tells grows with the time that it is listened to.
            if (traits_of(cause.finding.effect).is_noise) {
                const double times = std::ceil(decided_nats / std::max(rival.evidence_below_best_nats, 0.5));
                proposal += ", some " + std::to_string(std::max(2, static_cast<int>(times))) +
                            " times as long as this one";
            }
            answer_.next_recordings.push_back(std::move(proposal));
        }
        if (answer_.verdict == Verdict::unexplained) {
            answer_.next_recordings.emplace_back(
                "what is not explained: a second recording under the same conditions tells whether it comes "
                "back at the same place, and one under others (temperature, supply, mounting, sample rate) "
                "what "
                "it depends on");
        }
    }

    void validate_halves() {
        std::vector<Finding> causes;
        for (const FoundCause& found : found_->causes) { causes.push_back(found.finding); }
        answer_.split_half = validate_by_halves(prediction_->with(found_->without_causes), recording_, causes,
                                                options_.seed, options_.threads);
    }

    // Of a gap that is not explained the causes are no more than a guess.
    bool widen_uncertainties() {
        if (answer_.verdict != Verdict::known) { return true; }
        BootstrapOptions options{.seed = options_.seed, .threads = options_.threads};
        options.on_progress = [&](double share) {
            return told("looking how well the parameters are known", share);
        };
        std::vector<Finding> causes;
        for (const Cause& cause : answer_.causes) { causes.push_back(cause.finding); }
        std::optional<std::vector<Finding>> known = with_bootstrap_sd(
            prediction_->with(found_->without_causes), answer_.corrected, std::move(causes), options);
        if (!known) { return false; }
        for (std::size_t i = 0; i < known->size(); ++i) {
            answer_.causes[i].finding = std::move((*known)[i]);
        }
        return true;
    }

    // Along what the causes change, the distance of a recording is sqrt(2 gain / parameters), a simulation's
    // is 1 (twice a log likelihood ratio is chi-square with as many degrees of freedom as parameters). Of the
    // distance, what the parameters' own error leaves is chi-square likewise; and what fits of the halves
    // leave in excess of that.
    void close_by_causes() {
        double gain_nats = 0.0;
        double parameters = 0.0;
        for (const Cause& cause : answer_.causes) {
            const double own = std::max(1, cause.finding.parameters);
            gain_nats += cause.finding.gain_nats;
            parameters += own;
        }
        const auto left = [&](double square) {
            const double excess = 2.0 * answer_.split_half.excess_nats;
            return std::clamp(1.0 - (square + excess) / (2.0 * gain_nats), 0.0, 1.0);
        };
        answer_.shrink = left(parameters);
        answer_.shrink_lo = left(chi_squared_quantile(parameters, 0.975));
        answer_.shrink_hi = left(chi_squared_quantile(parameters, 0.025));
        const double along = std::sqrt(1.0 + 2.0 * gain_nats / parameters);
        if (along > answer_.gap_before.value) {
            const double sd = std::sqrt((2.0 * along * along - 1.0) / (2.0 * parameters)) / along;
            answer_.gap_before = {along, 1.0, std::max(1.0, along - 1.96 * sd), along + 1.96 * sd};
        }
        const auto after = [&](double shrink) {
            const double before = answer_.gap_before.value;
            return std::sqrt(1.0 + (1.0 - shrink) * (before * before - 1.0));
        };
        answer_.gap_after = {after(answer_.shrink), 1.0, after(answer_.shrink_hi), after(answer_.shrink_lo)};
    }

    // The gap of a recording that had no part in the fit.
    std::optional<GapSummary> gap_on_holdout(const std::shared_ptr<const RecordedWorld>& world,
                                             const SensorModel& model) {
        const auto prediction =
            with_own_start(std::make_shared<const Prediction>(world, model), options_.holdout);
        NullSimulationOptions options = simulation_options(
            std::min(options_.simulations, simulations_after_most), RandomPurpose::holdout_simulations);
        options.on_progress = [&](double share) { return told("judging the second recording", share); };
        const std::optional<NullSimulations> null = simulate_null(prediction, nullptr, options);
        if (!null) { return std::nullopt; }
        const Observation observation(prediction, options_.holdout, options_.seed);
        return summarise(gap_curves(observation), gap_reference(null->curves));
    }

    bool measure_on_holdout() {
        const auto world = std::make_shared<const RecordedWorld>(options_.holdout);
        const std::optional<GapSummary> before = gap_on_holdout(world, prediction_->model());
        const SensorModel corrected = corrected_without_events();
        const std::optional<GapSummary> after =
            answer_.causes.empty() ? before : gap_on_holdout(world, corrected);
        if (!before || !after) { return false; }
        answer_.held_out = options_.holdout->name;
        answer_.gap_before = before->gap;
        answer_.gap_after = after->gap;
        const auto excess = [](double gap) { return std::max(gap * gap - 1.0, 0.0); };
        const double gap = excess(before->gap.value);
        const auto closed = [&](double left) {
            return gap > 0.0 ? std::clamp(1.0 - excess(left) / gap, 0.0, 1.0) : 0.0;
        };
        answer_.shrink = closed(after->gap.value);
        answer_.shrink_lo = closed(after->gap.hi);
        answer_.shrink_hi = closed(after->gap.lo);
        share_among_causes(answer_);
        return true;
    }

    // For another recording than that of the causes.
    SensorModel corrected_without_events() {
        for (const Cause& cause : answer_.causes) {
            const std::string& effect = cause.finding.effect;
            if (!is_event(effect)) { continue; }
            append_new(answer_.warnings,
                       {effect + " happened in the first recording: the second is judged without it"});
        }
        return without_events(answer_.corrected, prediction_->model().effects.size());
    }

    // The evidence of all effects as their probabilities, equal before the recording was seen.
    Cause cause_of(const FoundCause& found, bool explained) const {
        Cause cause{found.finding, 0.0, {}, 0.0, {}};
        double sum = 1.0;
        for (const Finding& rival : found.rivals) {
            if (rival.effect == found.finding.effect) { continue; }
            const double behind = found.finding.evidence_nats - rival.evidence_nats;
            sum += std::exp(-behind);
            if (behind < tie_nats && cause.tie_group.size() < tie_most) {
                cause.tie_group.push_back({rival.effect, behind});
            }
        }
        if (!cause.tie_group.empty()) {
            cause.tie_group.insert(cause.tie_group.begin(), {found.finding.effect, 0.0});
        }
        cause.score = (explained ? 1.0 : part_of_unexplained) / sum;
        const EffectSignature& signature = *find_effect(found.finding.effect)->signature;
        if (!cause.tie_group.empty()) { cause.decided_by = signature.decided_by; }
        return cause;
    }

    std::shared_ptr<const Recording> recording_;
    DiagnosisOptions options_;
    std::shared_ptr<const Prediction> prediction_;
    Diagnosis answer_;
    Hypotheses first_;
    GapReference before_;
    std::vector<GapCurve> before_curves_;
    std::optional<EvidenceTail> evidence_tail_;
    std::optional<EvidenceTail> surprise_tail_;
    std::optional<CauseSelection> found_;
    std::optional<GapReference> after_;
    std::vector<GapCurve> after_curves_;
    double surprise_left_nats_ = 0.0;
};

}  // namespace

std::string telling_apart(const std::string& effect) { return "to tell " + effect + " from "; }

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
