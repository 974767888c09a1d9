#include "analysis/diagnose/selection/forward_selection.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/noise_refit.hpp"
#include "analysis/diagnose/selection/finding_axes.hpp"
#include "analysis/diagnose/selection/joint_refit.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog::resolution {

// Bounds on the time only: what more is called for stays in the gap that is left.
constexpr std::size_t causes_most = 16;
// Of each estimator's best, so many are tried as the first cause, or as the next.
constexpr std::size_t tried_most = 4;
// Two causes of like size must not take turns for ever.
constexpr int main_causes_most = 3;
// Of what one response leaves, to fit it together with others.
constexpr double worth_refitting_nats = 100.0;
// Of responses, to fit them better than one by one.
constexpr double worth_settling_nats = 1000.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

enum class Rivals { may_replace, stay_out };

// What is seen beside causes.
struct Beside {
    double log_likelihood_nats = 0.0;
    std::vector<std::optional<Finding>> findings;  // by effect of the catalogue
};

class ForwardSelection {
public:
    ForwardSelection(const Hypotheses& first, std::shared_ptr<const Recording> recording,
                     const SelectionOptions& options)
        : first_(first),
          model_(first.prediction->model()),
          recording_(std::move(recording)),
          options_(options) {}

    std::optional<CauseSelection> run() {
        std::optional<Hypotheses> latest = with_first_cause();
        if (latest && settle_responses()) { latest = with_causes(); }
        // A cause that others make needless may come back for ever.
        const std::size_t rounds_most = 2 * resolution::causes_most;
        for (std::size_t round = 0; latest && round < rounds_most; ++round) {
            if (has_new_main_cause(*latest)) {
                if (!measure_null_bias(*latest->observation)) { return std::nullopt; }
                if (causes_.size() > 1 && !refit()) { return std::nullopt; }
                static_cast<void>(settle_responses());
                latest = with_causes();
            }
            // What is next is not known before the noise is.
            const bool freed = free_noise_of_model(*latest->observation);
            if (!told() || (freed && !refit_all())) { return std::nullopt; }
            std::optional<bool> grown = freed ? true : take_further(*latest);
            if (grown && !*grown) { grown = exchange(); }
            if (!grown) { return std::nullopt; }
            if (!*grown) { break; }
            forget_null_bias();
            latest = with_causes();
        }
        if (!are_weighed_ && !weigh()) { return std::nullopt; }
        return result_of(std::move(latest));
    }

    // `found` less one of its causes, the others fitted again.
    std::optional<CauseSelection> run_without(CauseSelection found, std::size_t cause) {
        model_ = std::move(found.without_causes);
        for (const NoiseRefit& refit : found.noise_refits) {
            if (std::ranges::count(free_axes_, refit.axis) == 0) { free_axes_.push_back(refit.axis); }
        }
        null_bias_ = std::move(found.null_bias);
        causes_ = std::move(found.causes);
        causes_.erase(causes_.begin() + static_cast<std::ptrdiff_t>(cause));
        forget_null_bias();
        static_cast<void>(settle_responses());
        // Those that are refitted first are so beside the others as these were.
        if (!refit(Rivals::stay_out) || !refit(Rivals::stay_out)) { return std::nullopt; }
        static_cast<void>(settle_responses());
        return result_of(with_causes());
    }

private:
    CauseSelection result_of(std::optional<Hypotheses> latest) {
        CauseSelection result;
        result.without_causes = model_;
        if (!free_axes_.empty()) {
            if (!causes_.empty()) { result.noise_refits = noise_refits(*latest->observation); }
            model_ = with_noise(first_.prediction->model(), result.noise_refits);
            latest = with_causes();
        }
        result.corrected = model_;
        for (const FoundCause& cause : causes_) {
            result.corrected = with_cause(std::move(result.corrected), cause.finding);
        }
        result.null_bias = null_bias_;
        result.causes = std::move(causes_);
        std::ranges::sort(result.causes, std::greater{},
                          [](const FoundCause& cause) { return cause.finding.evidence_nats; });
        if (latest) {
            result.last = *std::move(latest);
        } else {
            result.last = {first_.prediction, first_.observation, {}, {}};
        }
        return result;
    }

    // Where the axes are free, what their noise comes to with the causes in the model.
    std::vector<NoiseRefit> noise_refits(const Observation& with_causes) const {
        return fitted_noise(with_causes, first_.prediction->model(), free_axes_);
    }

    SensorModel refitted_model(const Observation& with_causes) const {
        return with_noise(first_.prediction->model(), noise_refits(with_causes));
    }

    Hypotheses with_causes() const {
        return examine(first_.prediction->with(model_with_all_but(causes_.size())), recording_, options_.seed,
                       options_.threads);
    }

    // The best finding of every estimator: noise may pass for a drift and a drift for noise, as long as the
    // other is not in the model.
    std::vector<Finding> beginnings() const {
        std::map<EvidenceMethod, Finding> best;
        for (const Finding& finding : findings_of(first_.findings)) {
            if (finding.evidence_nats < options_.evidence_min_nats) { break; }
            if (is_of_codes(finding)) { return {finding}; }
            best.try_emplace(traits_of(finding.effect, *first_.prediction).method, finding);
        }
        return best_first(std::move(best));
    }

    std::vector<Finding> best_first(std::map<EvidenceMethod, Finding> best) const {
        std::vector<Finding> found;
        found.reserve(best.size());
        for (auto& [method, finding] : best) { found.push_back(std::move(finding)); }
        std::ranges::sort(found, std::greater{}, &Finding::evidence_nats);
        if (found.size() > resolution::tried_most) { found.resize(resolution::tried_most); }
        return found;
    }

    // Those of the causes beside which the spectra's likelihood is another.
    static std::set<std::string> change_likelihood_among(const std::vector<FoundCause>& causes) {
        std::set<std::string> effects;
        for (const FoundCause& cause : causes) {
            if (traits_of(cause.finding.effect).changes_likelihood) { effects.insert(cause.finding.effect); }
        }
        return effects;
    }

    // It comes before all other causes, and stays.
    static bool is_of_codes(const Finding& finding) { return traits_of(finding.effect).is_of_codes; }

    // Null without causes.
    const Finding* main_cause() const {
        if (causes_.empty()) { return nullptr; }
        const Finding* main = &causes_.front().finding;
        if (is_of_codes(*main)) { return main; }
        for (const FoundCause& cause : causes_) {
            if (cause.finding.evidence_nats > main->evidence_nats) { main = &cause.finding; }
        }
        return main;
    }

    // What a further cause must have.
    double evidence_least_nats() const {
        const Finding* main = main_cause();
        const double formulas_nats = main == nullptr ? 0.0 : options_.formulas_share * main->evidence_nats;
        return std::max(options_.evidence_min_nats, formulas_nats);
    }

    // A cause changes what others are judged by where right formulas of it may differ by half a nat.
    bool is_huge(double evidence_nats) const { return 2.0 * options_.formulas_share * evidence_nats >= 1.0; }

    // One beside which others may only seem to be.
    bool has_new_main_cause(const Hypotheses& with_causes) const {
        if (causes_.empty() || (causes_.size() == 1 && further(with_causes.findings) == nullptr)) {
            return false;
        }
        const Finding* main = main_cause();
        if (!is_of_codes(*main) && !traits_of(main->effect).is_not_normal && !is_huge(main->evidence_nats)) {
            return false;
        }
        const bool is_new = main->effect != null_bias_.beside || main->where.axes != null_bias_.axes;
        return is_new && main_causes_ < resolution::main_causes_most;
    }

    // False when ended early. Simulations have the noise that was fitted: free, it would be drawn from all
    // that is possible.
    bool measure_null_bias(const Observation& with_causes) {
        const Finding* main = main_cause();
        const Hypotheses with_main =
            examine(first_.prediction->with(with_cause(refitted_model(with_causes), *main)), recording_,
                    options_.seed, options_.threads);
        auto nats = null_bias_nats(with_main, options_.seed, options_.threads, [&] { return told(); });
        if (!nats) { return false; }
        null_bias_ = {*std::move(nats), main->effect, main->where.axes};
        ++main_causes_;
        return true;
    }

    // Where the cause that it was beside is one no more.
    void forget_null_bias() {
        const bool is_there = std::ranges::any_of(
            causes_, [&](const FoundCause& cause) { return cause.finding.effect == null_bias_.beside; });
        if (!is_there) { null_bias_ = {}; }
    }

    bool is_fast_response(const Finding& finding) const {
        return traits_of(finding.effect, *first_.prediction).is_response &&
               !find_effect(finding.effect)->signature->slow;
    }

    // Of causes_, those that shape the motion.
    std::vector<std::size_t> fast_responses() const {
        std::vector<std::size_t> places;
        for (std::size_t i = 0; first_.prediction->moves() && i < causes_.size(); ++i) {
            if (is_fast_response(causes_[i].finding)) { places.push_back(i); }
        }
        return places;
    }

    double evidence_nats_of(const std::vector<std::size_t>& places) const {
        double nats = 0.0;
        for (const std::size_t i : places) { nats += causes_[i].finding.evidence_nats; }
        return nats;
    }

    // These and `more` fitted together, the other causes in the model.
    JointRefit fitted_together(const std::vector<std::size_t>& places, const Finding* more) const {
        SensorModel model = model_;
        std::vector<Finding> together;
        for (std::size_t i = 0; i < causes_.size(); ++i) {
            if (std::ranges::count(places, i) != 0) {
                together.push_back(causes_[i].finding);
            } else {
                model = with_open_cause(std::move(model), causes_[i].finding);
            }
        }
        if (more != nullptr) { together.push_back(*more); }
        return refit_jointly(*first_.prediction->with(model), recording_, std::move(together), options_.seed);
    }

    // A response is fitted as if those that the model is uncertain of, the latency before all, stayed as they
    // are without it. Where it changes much of the motion they do not. Whether parameters moved.
    bool settle_responses() {
        const std::vector<std::size_t> places = fast_responses();
        if (evidence_nats_of(places) < resolution::worth_settling_nats) { return false; }
        const JointRefit refit = fitted_together(places, nullptr);
        for (std::size_t i = 0; i < places.size(); ++i) { causes_[places[i]].finding = refit.findings[i]; }
        return refit.moved;
    }

    // What a response leaves that was fitted without another one looks like noise, and like more of it than
    // the other gains beside the first as it is. Takes the other if all fitted together do better than
    // `next`.
    bool add_response(const Beside& latest, const Finding& next) {
        const std::vector<std::size_t> places = fast_responses();
        const bool is_fast = is_fast_response(next);
        if (places.empty() || (!is_fast && next.evidence_nats < resolution::worth_refitting_nats)) {
            return false;
        }
        double best_nats = is_fast ? -1e300 : evidence_less_bias_nats(next);
        std::vector<Finding> best;
        for (const std::optional<Finding>& other : latest.findings) {
            if (!other || !is_fast_response(*other) || !is_new(*other)) { continue; }
            if (evidence_less_bias_nats(*other) < evidence_least_nats()) { continue; }
            JointRefit refit = fitted_together(places, &*other);
            const double cost_nats = other->gain_nats - evidence_less_bias_nats(*other);
            const double nats = refit.log_likelihood_nats - latest.log_likelihood_nats - cost_nats;
            if (!(nats > best_nats)) { continue; }
            best_nats = nats;
            best = std::move(refit.findings);
        }
        if (best.empty()) { return false; }
        for (std::size_t i = 0; i < places.size(); ++i) { causes_[places[i]].finding = best[i]; }
        causes_.push_back({best.back(), findings_of(latest.findings)});
        return true;
    }

    double evidence_less_bias_nats(const Finding& finding) const {
        return finding.evidence_nats - null_bias_.of(finding);
    }

    bool is_noise(const Finding& finding) const {
        return traits_of(finding.effect, *first_.prediction).is_noise;
    }

    // Takes the cause that is best together with the one it calls for next; what is seen with it in the
    // model. Empty where there is none.
    std::optional<Hypotheses> with_first_cause() {
        std::optional<Hypotheses> best;
        std::vector<FoundCause> best_causes;
        double best_nats = 0.0;
        bool best_leaves_nothing = false;
        const std::vector<Finding> first = beginnings();
        // What each then has is measured by what the other leaves: of huge ones the sum says nothing.
        const bool is_main = !first.empty() && is_huge(first.front().evidence_nats);
        const double better_by_nats =
            is_main ? std::max(decisions.strong_nats, options_.formulas_share * first.front().evidence_nats)
                    : decisions.strong_nats;
        for (const Finding& finding : first) {
            causes_ = {{finding, is_of_codes(finding) ? std::vector{finding} : findings_of(first_.findings)}};
            Hypotheses with_it = with_causes();
            const Finding* next = further(with_it.findings);
            const double claimed_nats = finding.evidence_nats + (next ? next->evidence_nats : 0.0);
            const double nats = is_main ? likelihood_with(with_it, next)
                                        : std::min(claimed_nats, realised_nats(finding, with_it, next));
            // What the second mends is only what the first spoils.
            if (nats <= 0.0) { continue; }
            // Noise takes up whatever is there; an answer of one shape that leaves nothing is the right one,
            // unless noise that leaves nothing either does far better.
            const bool explains_all = next == nullptr && !is_noise(finding) &&
                                      (!best_leaves_nothing || nats > best_nats - decisions.certain_nats());
            if (!best || explains_all || nats > best_nats + better_by_nats) {
                best = std::move(with_it);
                best_causes = causes_;
                best_nats = nats;
                best_leaves_nothing = next == nullptr;
            }
            if (explains_all) { break; }
        }
        causes_ = std::move(best_causes);
        return best;
    }

    // Of all measures: the spectra's likelihood, and what each cause gains beside them, less the price of its
    // freedom. What a cause explains in one measure and spoils in another counts against it.
    double worth_nats(const Observation& with_causes) const {
        return log_likelihood_nats(with_causes) + worth_beside_spectra_nats();
    }

    double worth_nats(const Hypotheses& with_causes, const Finding* next) const {
        if (next == nullptr) { return worth_nats(*with_causes.observation); }
        return worth_nats(
                   with_causes.observation->under(with_open_cause(with_causes.prediction->model(), *next))) +
               worth_beside_spectra_nats(*next);
    }

    double worth_beside_spectra_nats() const {
        double nats = 0.0;
        for (const FoundCause& cause : causes_) { nats += worth_beside_spectra_nats(cause.finding); }
        return nats;
    }

    static double worth_beside_spectra_nats(const Finding& finding) {
        const EstimatorTraits& traits = traits_of(finding.effect);
        const bool is_told_beside = traits.is_beside_spectra || !traits.twin.empty();
        return finding.evidence_nats - (is_told_beside ? finding.spectral_nats() : finding.gain_nats);
    }

    // What `first`, which is all of the causes, and `next` explain; no bound where the spectra's likelihood
    // is another.
    double realised_nats(const Finding& first, const Hypotheses& with_first, const Finding* next) const {
        const auto changes_likelihood = [](const Finding& finding) {
            return traits_of(finding.effect).changes_likelihood;
        };
        if (changes_likelihood(first) || (next != nullptr && changes_likelihood(*next))) {
            return std::numeric_limits<double>::infinity();
        }
        return worth_nats(with_first, next) - log_likelihood_nats(*first_.observation);
    }

    double likelihood_with(const Hypotheses& hypotheses, const Finding* next) const {
        if (next == nullptr) { return log_likelihood_nats(*hypotheses.observation); }
        const auto prediction =
            hypotheses.prediction->with(with_open_cause(hypotheses.prediction->model(), *next));
        return log_likelihood_nats({prediction, recording_, options_.seed});
    }

    bool told() const {
        const double share =
            static_cast<double>(causes_.size()) / static_cast<double>(resolution::causes_most + 1);
        return !options_.on_progress || options_.on_progress(share);
    }

    // The best first, by what is beyond the bias.
    std::vector<Finding> findings_of(const std::vector<std::optional<Finding>>& found) const {
        std::vector<Finding> findings;
        for (const std::optional<Finding>& finding : found) {
            if (!finding) { continue; }
            findings.push_back(*finding);
            findings.back().evidence_nats = evidence_less_bias_nats(*finding);
        }
        std::ranges::sort(findings, std::greater{}, &Finding::evidence_nats);
        return findings;
    }

    // The best finding that is not of an effect found before: what those could explain, their fit has. Null
    // where none has evidence enough.
    const Finding* further(const std::vector<std::optional<Finding>>& found) const {
        const Finding* best = nullptr;
        double best_nats = 0.0;
        for (const std::optional<Finding>& finding : found) {
            if (!finding || !is_new(*finding)) { continue; }
            const double evidence_nats = evidence_less_bias_nats(*finding);
            if (evidence_nats < evidence_least_nats()) { continue; }
            if (best == nullptr || evidence_nats > best_nats) { best = &*finding, best_nats = evidence_nats; }
        }
        return best;
    }

    // The best of each estimator that has evidence enough, the best first.
    std::vector<Finding> all_further(const std::vector<std::optional<Finding>>& found) const {
        std::map<EvidenceMethod, Finding> best;
        for (const Finding& finding : findings_of(found)) {
            if (finding.evidence_nats < evidence_least_nats()) { break; }
            if (!is_new(finding)) { continue; }
            best.try_emplace(traits_of(finding.effect, *first_.prediction).method, finding);
        }
        return best_first(std::move(best));
    }

    // Takes the first of the further causes with which, the others fitted again, all measures together are
    // better explained; where it spoils one, with what it calls for next. Whether there is such; no value
    // when ended early.
    std::optional<bool> take_further(Hypotheses& latest) {
        const std::vector<Finding> candidates = all_further(latest.findings);
        if (candidates.empty() || causes_.size() == resolution::causes_most) { return false; }
        const std::vector<FoundCause> before = causes_;
        const double before_nats = worth_nats(*latest.observation);
        const Beside beside = given_up(std::move(latest));
        for (const Finding& next : candidates) {
            causes_ = before;
            if (!add(beside, next)) { return std::nullopt; }
            if (is_of_codes(next) || change_likelihood_among(causes_) != change_likelihood_among(before)) {
                return true;
            }
            if (worth_nats(observed()) > before_nats) { return true; }
            if (causes_.size() == resolution::causes_most) { continue; }
            const std::optional<bool> mended = add_next();
            if (!mended) { return std::nullopt; }
            if (*mended && worth_nats(observed()) > before_nats) { return true; }
        }
        causes_ = before;
        latest = with_causes();
        return false;
    }

    // Each cause was chosen before those that were found after it, and these were fitted to what it left. So
    // each cause once gives its axes to the best rival of each estimator that explains them nearly as well.
    // All causes are refitted, and the best further cause is added. The first exchange stays that raises the
    // worth of all measures, or keeps it with fewer causes. The function returns whether any exchange stays;
    // no value when it was ended early.
    std::optional<bool> exchange() {
        bool any = false;
        for (std::size_t i = 0; !was_exchanged_ && i < causes_.size(); ++i) {
            for (const Finding& rival : best_rivals(causes_[i])) {
                const std::optional<bool> is_better = exchange_for(i, rival);
                if (!is_better) { return std::nullopt; }
                if (!*is_better) { continue; }
                any = true;
                break;
            }
        }
        was_exchanged_ = true;
        return any;
    }

    // Whether the exchange stays.
    std::optional<bool> exchange_for(std::size_t place, const Finding& rival) {
        const std::vector<FoundCause> before = causes_;
        if (!give_to_rival(place, rival)) { return false; }
        const double before_nats = worth_nats_of(before);
        // What was fitted beside the cause is fitted beside the rival before that is judged.
        if (!refit(Rivals::stay_out) || !refit(Rivals::stay_out)) { return std::nullopt; }
        const double more_nats = decisions.strong_nats;
        const bool were_weighed = std::exchange(are_weighed_, true);
        if (!add_next_if_worth(before_nats + more_nats)) { return std::nullopt; }
        const double least_nats = before_nats + (causes_.size() < before.size() ? -more_nats : more_nats);
        const bool is_better = change_likelihood_among(causes_) == change_likelihood_among(before) &&
                               worth_nats(observed()) > least_nats;
        if (!is_better) { causes_ = before, are_weighed_ = were_weighed; }
        return is_better;
    }

    // With what is called for next, where that may lift the worth above this. False when ended early.
    bool add_next_if_worth(double least_nats) {
        Hypotheses latest = with_causes();
        const Finding* next = further(latest.findings);
        if (next == nullptr || causes_.size() == resolution::causes_most) { return true; }
        if (worth_nats(*latest.observation) + next->evidence_nats <= least_nats) { return true; }
        const Finding chosen = *next;
        return add(given_up(std::move(latest)), chosen);
    }

    double worth_nats_of(const std::vector<FoundCause>& causes) {
        const std::vector<FoundCause> now = std::exchange(causes_, causes);
        const double nats = worth_nats(observed());
        causes_ = now;
        return nats;
    }

    // Of each estimator, the best first.
    std::vector<Finding> best_rivals(const FoundCause& cause) const {
        const EstimatorTraits& own = traits_of(cause.finding.effect);
        if (own.is_of_codes || own.recurs) { return {}; }
        std::map<EvidenceMethod, Finding> best;
        for (const Finding& rival : cause.rivals) {
            const EstimatorTraits& traits = traits_of(rival.effect, *first_.prediction);
            if (rival.effect == cause.finding.effect || traits.is_beside_spectra || traits.recurs) {
                continue;
            }
            if (axes_explained_by(rival, cause.finding, decisions.nearly_all).empty()) { continue; }
            best.try_emplace(traits.method, rival);
        }
        return best_first(std::move(best));
    }

    // The cause's axes that the rival explains nearly as well. Whether it took any.
    bool give_to_rival(std::size_t place, const Finding& rival) {
        const Finding cause = causes_[place].finding;
        const std::vector<std::size_t> given = axes_explained_by(rival, cause, decisions.nearly_all);
        std::vector<std::size_t> kept;
        std::ranges::set_difference(cause.where.axes, given, std::back_inserter(kept));
        if (kept.empty() && traits_of(cause.effect).changes_likelihood) { return false; }
        std::vector<FoundCause> causes = causes_;
        if (kept.empty()) {
            causes.erase(causes.begin() + static_cast<std::ptrdiff_t>(place));
        } else {
            const std::optional<Finding> rest = on_axes(cause, kept);
            if (!rest) { return false; }
            causes[place].finding = *rest;
        }
        const bool is_whole = given.size() == rival.where.axes.size();
        const std::optional<Finding> taken = is_whole ? rival : on_axes(rival, given);
        if (!taken || !take_into(causes, *taken, kept.empty() ? place : causes.size())) { return false; }
        causes_ = std::move(causes);
        return true;
    }

    // As a cause of its own at this place; one of the same effect has the axes beside its own. Whether it
    // can.
    static bool take_into(std::vector<FoundCause>& causes, const Finding& finding, std::size_t place) {
        const auto same = std::ranges::find(causes, finding.effect,
                                            [](const FoundCause& found) { return found.finding.effect; });
        if (same == causes.end()) {
            causes.insert(causes.begin() + static_cast<std::ptrdiff_t>(place), {finding, {}});
            return true;
        }
        std::optional<Finding> more = on_more_axes(same->finding, finding);
        if (!more) { return false; }
        same->finding = *std::move(more);
        return true;
    }

    // Of a long recording an observation is large: the fits that follow make their own.
    static Beside given_up(Hypotheses hypotheses) {
        return {log_likelihood_nats(*hypotheses.observation), std::move(hypotheses.findings)};
    }

    // Whether there is a further cause; no value when ended early.
    std::optional<bool> add_next() {
        Hypotheses latest = with_causes();
        const Finding* next = further(latest.findings);
        if (next == nullptr) { return false; }
        const Finding chosen = *next;
        if (!add(given_up(std::move(latest)), chosen)) { return std::nullopt; }
        return true;
    }

    // False when ended early.
    bool add(const Beside& causes, const Finding& next) {
        if (!add_response(causes, next)) { causes_.push_back({next, findings_of(causes.findings)}); }
        return told() && refit_all();
    }

    bool is_new(const Finding& finding) const {
        return !is_told_by_twin(finding) && std::ranges::none_of(causes_, [&](const FoundCause& cause) {
            if (cause.finding.effect != finding.effect) { return false; }
            return !traits_of(finding.effect).recurs || is_same_line(cause.finding, finding);
        });
    }

    // A second part of the same spectrum is not yet what its name says.
    bool is_told_by_twin(const Finding& finding) const {
        const std::string_view twin = traits_of(finding.effect).twin;
        return !twin.empty() && finding.beside_nats() < decisions.strong_nats &&
               std::ranges::any_of(causes_,
                                   [&](const FoundCause& cause) { return cause.finding.effect == twin; });
    }

    // What a steady line leaves beside itself is no other line: it wanders, or swells.
    bool is_same_line(const Finding& a, const Finding& b) const {
        if (!a.where.freq_hz || !b.where.freq_hz) { return false; }
        const double near_hz = options_.same_line_resolutions / first_.prediction->duration_s();
        return a.where.freq_hz->from < b.where.freq_hz->to + near_hz &&
               b.where.freq_hz->from < a.where.freq_hz->to + near_hz;
    }

    // An estimator of an effect that recurs gives its best, which may be what another such cause leaves: that
    // tells nothing of this one.
    bool is_of_another(const Finding& finding, std::size_t own) const {
        if (!traits_of(finding.effect).recurs || is_same_line(causes_[own].finding, finding)) {
            return false;
        }
        for (std::size_t i = 0; i < causes_.size(); ++i) {
            const Finding& other = causes_[i].finding;
            if (i != own && other.effect == finding.effect && is_same_line(other, finding)) { return true; }
        }
        return false;
    }

    SensorModel model_with_all_but(std::size_t left_out) const {
        SensorModel model = model_;
        for (std::size_t i = 0; i < causes_.size(); ++i) {
            if (i != left_out) { model = with_open_cause(std::move(model), causes_[i].finding); }
        }
        return model;
    }

    // With the causes in the model, noise that a fit took for them is in it twice. Whether another axis has
    // such noise.
    bool free_noise_of_model(const Observation& with_causes) {
        // A coarse step leaves less noise than its spectrum has, too.
        if (causes_.empty() || is_of_codes(causes_.front().finding)) { return false; }
        bool more = false;
        for (const std::size_t axis : axes_to_refit(with_causes)) {
            if (std::ranges::count(free_axes_, axis) != 0) { continue; }
            free_axes_.push_back(axis);
            more = true;
        }
        if (more) { model_ = with_free_noise(std::move(model_), with_causes, free_axes_); }
        return more;
    }

    // Every cause with the others in the model; one that another effect does better by now gives way to it.
    bool refit(Rivals rivals = Rivals::may_replace) {
        for (std::size_t i = 0; i < causes_.size();) {
            const Hypotheses without = examine(first_.prediction->with(model_with_all_but(i)), recording_,
                                               options_.seed, options_.threads);
            const std::vector<Finding> findings = findings_of(without.findings);
            const auto same = std::ranges::find(findings, causes_[i].finding.effect, &Finding::effect);
            const double least_nats =
                &causes_[i].finding == main_cause() ? options_.evidence_min_nats : evidence_least_nats();
            const double own_nats =
                same == findings.end() || is_told_by_twin(*same) ? 0.0 : same->evidence_nats;
            const auto rival = std::ranges::find_if(findings, [&](const Finding& f) { return is_new(f); });
            const double rival_nats = rival == findings.end() ? 0.0 : rival->evidence_nats;
            if (same != findings.end() && is_of_another(*same, i)) {
                // It stays.
            } else if (is_of_codes(causes_[i].finding)) {
                if (same != findings.end()) { causes_[i].finding = *same; }
            } else if (rivals == Rivals::may_replace && rival_nats > own_nats + decisions.strong_nats &&
                       rival_nats >= least_nats) {
                causes_[i].finding = *rival;
            } else if (own_nats >= least_nats) {
                causes_[i].finding = *same;
            } else {
                causes_.erase(causes_.begin() + static_cast<std::ptrdiff_t>(i));
                continue;
            }
            causes_[i].rivals = rivals_of(causes_[i].finding, findings);
            ++i;
            if (!told()) { return false; }
        }
        return true;
    }

    // What is a cause already is no rival of another, unless on axes that it has not taken.
    bool is_rival(const Finding& finding, const Finding& cause) const {
        if (is_new(finding)) { return true; }
        if (traits_of(finding.effect).recurs || is_told_by_twin(finding)) { return false; }
        const auto same = std::ranges::find(causes_, finding.effect,
                                            [](const FoundCause& found) { return found.finding.effect; });
        return same != causes_.end() && std::ranges::none_of(cause.where.axes, [&](std::size_t axis) {
                   return std::ranges::count(same->finding.where.axes, axis) != 0;
               });
    }

    std::vector<Finding> rivals_of(const Finding& cause, const std::vector<Finding>& findings) const {
        std::vector<Finding> rivals;
        std::ranges::copy_if(findings, std::back_inserter(rivals), [&](const Finding& f) {
            return f.effect == cause.effect || (is_rival(f, cause) && !is_of_codes(cause));
        });
        return rivals;
    }

    // Evidence and rivals of causes beside the others as they are now. The parameters, which were fitted
    // together, stay: a fit one by one would find others, and less evidence for them.
    bool weigh() {
        const double with_all_nats = log_likelihood_nats(observed());
        for (std::size_t i = 0; i < causes_.size(); ++i) {
            const Hypotheses without = examine(first_.prediction->with(model_with_all_but(i)), recording_,
                                               options_.seed, options_.threads);
            const std::vector<Finding> findings = findings_of(without.findings);
            Finding& cause = causes_[i].finding;
            causes_[i].rivals = rivals_of(cause, findings);
            const double more_nats =
                with_all_nats - log_likelihood_nats(*without.observation) - cause.gain_nats;
            if (more_nats > 0.0) {
                cause.gain_nats += more_nats;
                cause.evidence_nats += more_nats;
            }
            if (!told()) { return false; }
        }
        return true;
    }

    // The responses among the causes together, too. One by one each is fitted to what the others' errors
    // leave, and another may take its place: what explains less than before all of them together is no
    // better. A cause that is dropped as needless had less than a further one needs. Beside the spectra a
    // cause has what it was found with, which others may have explained since: having less is no loss.
    bool refit_all() {
        const std::vector<FoundCause> before = causes_;
        const double likelihood_before_nats = log_likelihood_nats(observed());
        const double beside_before_nats = worth_beside_spectra_nats();
        if (!refit()) { return false; }
        static_cast<void>(settle_responses());
        const double gained_nats = log_likelihood_nats(observed()) - likelihood_before_nats +
                                   std::max(worth_beside_spectra_nats() - beside_before_nats, 0.0);
        const double dropped = static_cast<double>(before.size() - std::min(before.size(), causes_.size()));
        are_weighed_ = gained_nats >= -dropped * evidence_least_nats() - decisions.strong_nats ||
                       change_likelihood_among(before) != change_likelihood_among(causes_);
        if (!are_weighed_) { causes_ = before; }
        return true;
    }

    Observation observed() const {
        return {first_.prediction->with(model_with_all_but(causes_.size())), recording_, options_.seed};
    }

    const Hypotheses& first_;
    SensorModel model_;  // without causes
    std::shared_ptr<const Recording> recording_;
    SelectionOptions options_;
    std::vector<FoundCause> causes_;
    std::vector<std::size_t> free_axes_;
    NullBias null_bias_;
    int main_causes_ = 0;
    bool are_weighed_ = true;  // as they were when each was found, otherwise
    bool was_exchanged_ = false;
};

}  // namespace

std::optional<CauseSelection> select_causes(const Hypotheses& first,
                                            const std::shared_ptr<const Recording>& recording,
                                            const SelectionOptions& options) {
    return ForwardSelection(first, recording, options).run();
}

std::optional<CauseSelection> without_cause(CauseSelection found, std::size_t cause, const Hypotheses& first,
                                            const std::shared_ptr<const Recording>& recording,
                                            const SelectionOptions& options) {
    return ForwardSelection(first, recording, options).run_without(std::move(found), cause);
}

}  // namespace gyrolog
