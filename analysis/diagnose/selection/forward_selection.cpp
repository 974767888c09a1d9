#include "analysis/diagnose/selection/forward_selection.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/noise_refit.hpp"
#include "analysis/diagnose/selection/joint_refit.hpp"

namespace gyrolog::resolution {

// Bounds on the time only: what more is called for stays in the gap that is left.
constexpr std::size_t causes_most = 16;
// Two causes of like size must not take turns for ever.
constexpr int main_causes_most = 3;
// Of what one response leaves, to fit it together with others.
constexpr double worth_refitting_nats = 100.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// What is seen beside causes.
struct Beside {
    double log_likelihood_nats = 0.0;
    std::vector<std::optional<Finding>> findings;  // by effect of the catalogue
};

class ForwardSelection {
public:
    ForwardSelection(const Hypotheses& first, const std::shared_ptr<const Recording>& recording,
                     const SelectionOptions& options)
        : first_(first), recording_(recording), options_(options), set_(first, recording, options) {}

    std::optional<CauseSelection> run() {
        std::optional<Hypotheses> latest = with_first_cause();
        if (latest && set_.settle_responses()) { latest = set_.with_causes(); }
        // A cause that others make needless may come back for ever.
        const std::size_t rounds_most = 2 * resolution::causes_most;
        for (std::size_t round = 0; latest && round < rounds_most; ++round) {
            if (has_new_main_cause(*latest)) {
                if (!measure_null_bias(*latest->observation)) { return std::nullopt; }
                if (set_.causes.size() > 1 && !refit()) { return std::nullopt; }
                static_cast<void>(set_.settle_responses());
                latest = set_.with_causes();
            }
            // What is next is not known before the noise is.
            const bool freed = free_noise_of_model(*latest->observation);
            if (!told() || (freed && !refit_all())) { return std::nullopt; }
            std::optional<bool> grown = freed ? true : take_further(*latest);
            if (grown && !*grown) { grown = exchange(); }
            if (!grown) { return std::nullopt; }
            if (!*grown) { grown = leave_out_needless(); }
            if (!grown) { return std::nullopt; }
            if (!*grown) { break; }
            forget_null_bias();
            latest = set_.with_causes();
        }
        if (!are_weighed_ && !weigh()) { return std::nullopt; }
        return result_of(std::move(latest));
    }

    // `found` less one of its causes, the others fitted again.
    std::optional<CauseSelection> run_without(CauseSelection found, std::size_t cause) {
        set_.without_causes = std::move(found.without_causes);
        for (const NoiseRefit& refit : found.noise_refits) {
            if (std::ranges::count(free_axes_, refit.axis) == 0) { free_axes_.push_back(refit.axis); }
        }
        set_.null_bias = std::move(found.null_bias);
        set_.causes = std::move(found.causes);
        set_.causes.erase(set_.causes.begin() + static_cast<std::ptrdiff_t>(cause));
        forget_null_bias();
        static_cast<void>(set_.settle_responses());
        // Those that are refitted first are so beside the others as these were.
        if (!refit_in_turns()) { return std::nullopt; }
        static_cast<void>(set_.settle_responses());
        set_.settle_spectra();
        if (!weigh()) { return std::nullopt; }
        return result_of(set_.with_causes());
    }

private:
    CauseSelection result_of(std::optional<Hypotheses> latest) {
        CauseSelection result;
        result.without_causes = set_.without_causes;
        if (!free_axes_.empty()) {
            if (!set_.causes.empty()) { result.noise_refits = noise_refits(*latest->observation); }
            set_.without_causes = with_noise(first_.prediction->model(), result.noise_refits);
            latest = set_.with_causes();
        }
        result.corrected = set_.without_causes;
        for (const FoundCause& cause : set_.causes) {
            result.corrected = with_cause(std::move(result.corrected), cause.finding);
        }
        result.null_bias = set_.null_bias;
        result.causes = std::move(set_.causes);
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

    // The best finding of every estimator: noise may pass for a drift and a drift for noise, as long as the
    // other is not in the model.
    std::vector<Finding> beginnings() const {
        std::map<EvidenceMethod, Finding> best;
        for (const Finding& finding : set_.findings_of(first_.findings)) {
            if (finding.evidence_nats < options_.evidence_min_nats) { break; }
            if (CauseSet::is_of_codes(finding)) { return {finding}; }
            best.try_emplace(traits_of(finding.effect, *first_.prediction).method, finding);
        }
        return CauseSet::best_first(std::move(best));
    }

    // One beside which others may only seem to be.
    bool has_new_main_cause(const Hypotheses& with_causes) const {
        if (set_.causes.empty() ||
            (set_.causes.size() == 1 && set_.further(with_causes.findings) == nullptr)) {
            return false;
        }
        const Finding* main = set_.main_cause();
        if (!CauseSet::is_of_codes(*main) && !traits_of(main->effect).is_not_normal &&
            !set_.is_huge(main->evidence_nats)) {
            return false;
        }
        const bool is_new = main->effect != set_.null_bias.beside || main->where.axes != set_.null_bias.axes;
        return is_new && main_causes_ < resolution::main_causes_most;
    }

    // False when ended early. Simulations have the noise that was fitted: free, it would be drawn from all
    // that is possible.
    bool measure_null_bias(const Observation& with_causes) {
        const Finding* main = set_.main_cause();
        const Hypotheses with_main =
            examine(first_.prediction->with(with_cause(refitted_model(with_causes), *main)), recording_,
                    options_.seed, options_.threads);
        auto nats = null_bias_nats(with_main, options_.seed, options_.threads, [&] { return told(); });
        if (!nats) { return false; }
        set_.null_bias = {*std::move(nats), main->effect, main->where.axes};
        ++main_causes_;
        return true;
    }

    // Where the cause that it was beside is one no more.
    void forget_null_bias() {
        const bool is_there = std::ranges::any_of(set_.causes, [&](const FoundCause& cause) {
            return cause.finding.effect == set_.null_bias.beside;
        });
        if (!is_there) { set_.null_bias = {}; }
    }

    // What a response leaves that was fitted without another one looks like noise, and like more of it than
    // the other gains beside the first as it is. Takes the other if all fitted together do better than
    // `next`.
    bool add_response(const Beside& latest, const Finding& next) {
        const std::vector<std::size_t> places = set_.fast_responses();
        const bool is_fast = set_.is_fast_response(next);
        if (places.empty() || (!is_fast && next.evidence_nats < resolution::worth_refitting_nats)) {
            return false;
        }
        double best_nats = is_fast ? -1e300 : set_.evidence_less_bias_nats(next);
        std::vector<Finding> best;
        for (const std::optional<Finding>& other : latest.findings) {
            if (!other || !set_.is_fast_response(*other) || !set_.is_new(*other)) { continue; }
            if (set_.evidence_less_bias_nats(*other) < set_.evidence_least_nats()) { continue; }
            JointRefit refit = set_.fitted_together(places, &*other);
            const double cost_nats = other->gain_nats - set_.evidence_less_bias_nats(*other);
            const double nats = refit.log_likelihood_nats - latest.log_likelihood_nats - cost_nats;
            if (!(nats > best_nats)) { continue; }
            best_nats = nats;
            best = std::move(refit.findings);
        }
        if (best.empty()) { return false; }
        for (std::size_t i = 0; i < places.size(); ++i) { set_.causes[places[i]].finding = best[i]; }
        set_.causes.push_back({best.back(), set_.findings_of(latest.findings)});
        return true;
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
        const bool is_main = !first.empty() && set_.is_huge(first.front().evidence_nats);
        const double better_by_nats =
            is_main ? std::max(decisions.strong_nats, options_.formulas_share * first.front().evidence_nats)
                    : decisions.strong_nats;
        for (const Finding& finding : first) {
            set_.causes = {{finding, CauseSet::is_of_codes(finding) ? std::vector{finding}
                                                                    : set_.findings_of(first_.findings)}};
            Hypotheses with_it = set_.with_causes();
            const Finding* next = set_.further(with_it.findings);
            const double claimed_nats = finding.evidence_nats + (next ? next->evidence_nats : 0.0);
            const double nats = is_main ? likelihood_with(with_it, next)
                                        : std::min(claimed_nats, realised_nats(finding, with_it, next));
            // What the second mends is only what the first spoils.
            if (nats <= 0.0) { continue; }
            // Noise takes up whatever is there; an answer of one shape that leaves nothing is the right one,
            // unless noise that leaves nothing either does far better.
            const bool explains_all = next == nullptr && !set_.is_noise(finding) &&
                                      (!best_leaves_nothing || nats > best_nats - decisions.certain_nats());
            if (!best || explains_all || nats > best_nats + better_by_nats) {
                best = std::move(with_it);
                best_causes = set_.causes;
                best_nats = nats;
                best_leaves_nothing = next == nullptr;
            }
            if (explains_all) { break; }
        }
        set_.causes = std::move(best_causes);
        return best;
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
        return set_.worth_nats(with_first, next) - log_likelihood_nats(*first_.observation);
    }

    double likelihood_with(const Hypotheses& hypotheses, const Finding* next) const {
        if (next == nullptr) { return log_likelihood_nats(*hypotheses.observation); }
        const auto prediction =
            hypotheses.prediction->with(with_open_cause(hypotheses.prediction->model(), *next));
        return log_likelihood_nats({prediction, recording_, options_.seed});
    }

    bool told() const {
        const double share =
            static_cast<double>(set_.causes.size()) / static_cast<double>(resolution::causes_most + 1);
        return !options_.on_progress || options_.on_progress(share);
    }

    // Takes the first of the further causes with which, the others fitted again, all measures together are
    // better explained; where it spoils one, with what it calls for next. Whether there is such; no value
    // when ended early.
    std::optional<bool> take_further(Hypotheses& latest) {
        const std::vector<Finding> candidates = set_.all_further(latest.findings);
        if (candidates.empty() || set_.causes.size() == resolution::causes_most) { return false; }
        const std::vector<FoundCause> before = set_.causes;
        const double before_nats = set_.worth_nats(*latest.observation);
        const Beside beside = given_up(std::move(latest));
        for (const Finding& next : candidates) {
            set_.causes = before;
            if (!add(beside, next)) { return std::nullopt; }
            if (CauseSet::is_of_codes(next) || !compares_with(before)) { return true; }
            if (set_.worth_nats(set_.observed()) > before_nats) { return true; }
            if (set_.causes.size() == resolution::causes_most) { continue; }
            const std::optional<bool> mended = add_next();
            if (!mended) { return std::nullopt; }
            if (*mended && set_.worth_nats(set_.observed()) > before_nats) { return true; }
        }
        set_.causes = before;
        latest = set_.with_causes();
        return false;
    }

    // Each cause was chosen before those that were found after it, and these were fitted to what it left. So
    // each cause gives its axes to the best rival of each estimator that explains them nearly as well, or one
    // axis to a rival that explains it as well with fewer parameters. All causes are refitted. An exchange
    // stays that raises the worth of all measures by strong evidence, or that has fewer causes and is not
    // strongly worse, or fewer parameters and is no worse. If it does not, it is judged once more with the
    // best further cause. The function returns whether any exchange stays; no value when it was ended early.
    std::optional<bool> exchange() {
        bool any = false;
        const std::vector<FoundCause> each = was_exchanged_ ? std::vector<FoundCause>{} : set_.causes;
        for (const FoundCause& cause : each) {
            // What is left of a cause after an exchange may go elsewhere, axis by axis.
            for (std::size_t turn = 0; turn < cause.finding.where.axes.size(); ++turn) {
                const std::optional<std::size_t> place = set_.place_of(cause.finding);
                if (!place) { break; }  // an exchange has removed it
                const std::optional<bool> is_better = exchange_at(*place);
                if (!is_better) { return std::nullopt; }
                if (!*is_better) { break; }
                any = true;
            }
        }
        was_exchanged_ = true;
        return any;
    }

    // The first of the cause's rivals with which the exchange stays; whether there is one.
    std::optional<bool> exchange_at(std::size_t place) {
        for (const Finding& rival : set_.rivals_to_try(set_.causes[place])) {
            const std::optional<bool> is_better = exchange_for(place, rival);
            if (!is_better) { return std::nullopt; }
            if (!*is_better) { continue; }
            if (!are_weighed_ && !weigh()) { return std::nullopt; }
            return true;
        }
        return false;
    }

    // A cause has its evidence beside the others as they are. Fitted again without it, they may explain as
    // much: then it is left out. A fit together is quick and refuses most; one in turns tells whether the
    // others then need parameters of their own on axes that shared them. The function returns whether any is
    // left out; no value when ended early.
    std::optional<bool> leave_out_needless() {
        bool any = false;
        double worth_nats = set_.worth_nats(set_.observed());
        for (std::size_t i = 0; set_.causes.size() > 1 && i < set_.causes.size();) {
            if (!told()) { return std::nullopt; }
            const std::vector<FoundCause> before = set_.causes;
            if (!set_.leave_out_if_needless(i, worth_nats)) {
                ++i;
                continue;
            }
            if (!refit_in_turns()) { return std::nullopt; }
            set_.settle_spectra();
            const double without_nats = set_.worth_nats(set_.observed());
            if (compares_with(before) && without_nats > worth_nats - decisions.strong_nats) {
                worth_nats = without_nats;
                any = true;
            } else {
                set_.causes = before;
                ++i;
            }
        }
        if (any) { are_weighed_ = false; }
        return any;
    }

    // Whether the exchange stays.
    std::optional<bool> exchange_for(std::size_t place, const Finding& rival) {
        const std::vector<FoundCause> before = set_.causes;
        if (!set_.give_to_rival(place, rival)) { return false; }
        const double before_nats = worth_nats_of(before);
        // What was fitted beside the cause is fitted beside the rival before that is judged.
        if (!refit_in_turns()) { return std::nullopt; }
        set_.settle_spectra();
        const bool were_weighed = std::exchange(are_weighed_, false);
        if (is_better_than(before, before_nats)) { return true; }
        const std::optional<bool> added = add_next_if_worth(before_nats + least_gain_nats(before));
        if (!added) { return std::nullopt; }
        if (*added && is_better_than(before, before_nats)) { return true; }
        set_.causes = before;
        are_weighed_ = were_weighed;
        return false;
    }

    bool is_better_than(const std::vector<FoundCause>& before, double before_nats) const {
        return compares_with(before) &&
               set_.worth_nats(set_.observed()) > before_nats + least_gain_nats(before);
    }

    // Whether the spectra's likelihood is the same one.
    bool compares_with(const std::vector<FoundCause>& before) const {
        return CauseSet::change_likelihood_among(set_.causes) == CauseSet::change_likelihood_among(before);
    }

    // What an exchange that led from these causes to the present ones is to gain.
    double least_gain_nats(const std::vector<FoundCause>& before) const {
        if (set_.causes.size() < before.size()) { return -decisions.strong_nats; }
        const bool is_simpler = CauseSet::parameters(set_.causes) < CauseSet::parameters(before);
        return is_simpler ? 0.0 : decisions.strong_nats;
    }

    // Adds the best further cause where it may lift the worth above this. What changes the likelihood would
    // leave nothing to compare. Whether one is added; no value when ended early.
    std::optional<bool> add_next_if_worth(double least_nats) {
        if (set_.causes.size() == resolution::causes_most) { return false; }
        Hypotheses latest = set_.with_causes();
        const std::vector<Finding> findings = set_.findings_of(latest.findings);
        const auto next = std::ranges::find_if(findings, [&](const Finding& one) {
            return one.evidence_nats >= set_.evidence_least_nats() && set_.is_new(one) &&
                   !traits_of(one.effect).changes_likelihood;
        });
        if (next == findings.end()) { return false; }
        if (set_.worth_nats(*latest.observation) + next->evidence_nats <= least_nats) { return false; }
        if (!add(given_up(std::move(latest)), *next)) { return std::nullopt; }
        return true;
    }

    double worth_nats_of(const std::vector<FoundCause>& causes) {
        const std::vector<FoundCause> now = std::exchange(set_.causes, causes);
        const double nats = set_.worth_nats(set_.observed());
        set_.causes = now;
        return nats;
    }

    // Of a long recording an observation is large: the fits that follow make their own.
    static Beside given_up(Hypotheses hypotheses) {
        return {log_likelihood_nats(*hypotheses.observation), std::move(hypotheses.findings)};
    }

    // Whether there is a further cause; no value when ended early.
    std::optional<bool> add_next() {
        Hypotheses latest = set_.with_causes();
        const Finding* next = set_.further(latest.findings);
        if (next == nullptr) { return false; }
        const Finding chosen = *next;
        if (!add(given_up(std::move(latest)), chosen)) { return std::nullopt; }
        return true;
    }

    // False when ended early.
    bool add(const Beside& causes, const Finding& next) {
        if (!add_response(causes, next)) { set_.causes.push_back({next, set_.findings_of(causes.findings)}); }
        return told() && refit_all();
    }

    // With the causes in the model, noise that a fit took for them is in it twice. Whether another axis has
    // such noise.
    bool free_noise_of_model(const Observation& with_causes) {
        // A coarse step leaves less noise than its spectrum has, too.
        if (set_.causes.empty() || CauseSet::is_of_codes(set_.causes.front().finding)) { return false; }
        bool more = false;
        for (const std::size_t axis : axes_to_refit(with_causes)) {
            if (std::ranges::count(free_axes_, axis) != 0) { continue; }
            free_axes_.push_back(axis);
            more = true;
        }
        if (more) {
            set_.without_causes = with_free_noise(std::move(set_.without_causes), with_causes, free_axes_);
        }
        return more;
    }

    // Every cause with the others in the model; one that another effect does better by now gives way to it.
    bool refit() {
        Hypotheses beside_all = set_.with_causes();
        for (std::size_t i = 0; i < set_.causes.size();) {
            const std::vector<Finding> findings = set_.findings_of(set_.without(i).findings);
            const auto same = std::ranges::find(findings, set_.causes[i].finding.effect, &Finding::effect);
            const Finding* again = same == findings.end() ? nullptr : &*same;
            const Finding* rival = set_.gives_way_to(i, again, findings, beside_all);
            if (rival != nullptr) { set_.causes[i].finding = *rival; }
            const bool stays = rival != nullptr || take_again(i, again);
            if (stays) {
                set_.causes[i].rivals = set_.rivals_of(set_.causes[i].finding, findings);
                ++i;
            }
            if (rival != nullptr || !stays) { beside_all = set_.with_causes(); }
            if (!told()) { return false; }
        }
        return true;
    }

    // The same with no rivals: they are not asked.
    bool refit_own() {
        for (std::size_t i = 0; i < set_.causes.size();) {
            const std::optional<Finding> again = set_.found_again(i);
            if (take_again(i, again ? &*again : nullptr)) { ++i; }
            if (!told()) { return false; }
        }
        return true;
    }

    // Fits the spectra together and then each cause by its own estimator, twice: after the first, estimators
    // drop the axes that a cause is not needed on any more. False when ended early.
    bool refit_in_turns() {
        for (int turn = 0; turn < 2; ++turn) {
            set_.settle_spectra();
            if (!refit_own()) { return false; }
        }
        return true;
    }

    // The cause as its effect is found again, null where it is not. A cause that has too little evidence by
    // now is no more; whether it stays.
    bool take_again(std::size_t cause, const Finding* again) {
        if (again != nullptr && set_.is_of_another(*again, cause)) { return true; }
        Finding& finding = set_.causes[cause].finding;
        if (CauseSet::is_of_codes(finding)) {
            if (again != nullptr) { finding = *again; }
            return true;
        }
        if (set_.own_nats(again) >= set_.needed_nats(cause)) {
            finding = *again;
            return true;
        }
        set_.causes.erase(set_.causes.begin() + static_cast<std::ptrdiff_t>(cause));
        return false;
    }

    // Evidence and rivals of causes beside the others as they are now. The parameters, which were fitted
    // together, stay: a fit one by one would find others, and less evidence for them.
    bool weigh() {
        const double with_all_nats = log_likelihood_nats(set_.observed());
        for (std::size_t i = 0; i < set_.causes.size(); ++i) {
            const Hypotheses without = set_.without(i);
            const std::vector<Finding> findings = set_.findings_of(without.findings);
            Finding& cause = set_.causes[i].finding;
            set_.causes[i].rivals = set_.rivals_of(cause, findings);
            const double more_nats =
                with_all_nats - log_likelihood_nats(*without.observation) - cause.gain_nats;
            if (more_nats > 0.0) {
                cause.gain_nats += more_nats;
                cause.evidence_nats += more_nats;
            }
            if (!told()) { return false; }
        }
        are_weighed_ = true;
        return true;
    }

    // The responses among the causes together, too. One by one each is fitted to what the others' errors
    // leave, and another may take its place: what explains less than before all of them together is no
    // better. A cause that is dropped as needless had less than a further one needs. Beside the spectra a
    // cause has what it was found with, which others may have explained since: having less is no loss.
    bool refit_all() {
        const std::vector<FoundCause> before = set_.causes;
        const double likelihood_before_nats = log_likelihood_nats(set_.observed());
        const double beside_before_nats = set_.worth_beside_spectra_nats();
        set_.settle_spectra();
        if (!refit()) { return false; }
        static_cast<void>(set_.settle_responses());
        set_.settle_spectra();
        const double gained_nats = log_likelihood_nats(set_.observed()) - likelihood_before_nats +
                                   std::max(set_.worth_beside_spectra_nats() - beside_before_nats, 0.0);
        const double dropped =
            static_cast<double>(before.size() - std::min(before.size(), set_.causes.size()));
        are_weighed_ = gained_nats >= -dropped * set_.evidence_least_nats() - decisions.strong_nats ||
                       !compares_with(before);
        if (!are_weighed_) { set_.causes = before; }
        return true;
    }

    const Hypotheses& first_;
    std::shared_ptr<const Recording> recording_;
    SelectionOptions options_;
    CauseSet set_;
    std::vector<std::size_t> free_axes_;
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
