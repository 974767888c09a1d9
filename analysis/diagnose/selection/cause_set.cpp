#include "analysis/diagnose/selection/cause_set.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include "analysis/diagnose/estimators/same_cause.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/selection/finding_axes.hpp"
#include "analysis/diagnose/selection/spectra_refit.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

// Of each estimator's best, so many are tried as the first cause, or as the next.
constexpr std::size_t tried_most = 4;
// Of responses, to fit them better than one by one.
constexpr double worth_settling_nats = 1000.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

const std::string& effect_name(const FoundCause& cause) { return cause.finding.effect; }

// The finding becomes a cause of its own at this place; where its effect is a cause already, that one gains
// the axes. False where it cannot.
bool take_into(std::vector<FoundCause>& causes, const Finding& finding, std::size_t place) {
    const auto same = std::ranges::find(causes, finding.effect, effect_name);
    if (same == causes.end()) {
        causes.insert(causes.begin() + static_cast<std::ptrdiff_t>(place), {finding, {}});
        return true;
    }
    std::optional<Finding> more = on_more_axes(same->finding, finding);
    if (!more) { return false; }
    same->finding = *std::move(more);
    return true;
}

}  // namespace

CauseSet::CauseSet(const Hypotheses& first, std::shared_ptr<const Recording> recording,
                   const SelectionOptions& options)
    : without_causes(first.prediction->model()),
      first_(first),
      recording_(std::move(recording)),
      options_(options) {}

SensorModel CauseSet::model_with_all_but(std::size_t left_out) const {
    SensorModel model = without_causes;
    for (std::size_t i = 0; i < causes.size(); ++i) {
        if (i != left_out) { model = with_open_cause(std::move(model), causes[i].finding); }
    }
    return model;
}

Hypotheses CauseSet::without(std::size_t left_out) const {
    auto prediction = first_.prediction->with(model_with_all_but(left_out));
    return examine(prediction, std::make_shared<const Observation>(prediction, observed()), options_.threads);
}

std::optional<Finding> CauseSet::found_again(std::size_t cause) const {
    std::optional<Finding> found = examine_for(
        causes[cause].finding.effect, first_.prediction->with(model_with_all_but(cause)), observed());
    if (found) { found->evidence_nats = evidence_less_bias_nats(*found); }
    return found;
}

Hypotheses CauseSet::with_causes() const {
    auto prediction = first_.prediction->with(model_with_all_but(causes.size()));
    return examine(prediction, recording_, options_.seed, options_.threads);
}

Observation CauseSet::observed() const {
    return {first_.prediction->with(model_with_all_but(causes.size())), recording_, options_.seed};
}

const Finding* CauseSet::main_cause() const {
    if (causes.empty()) { return nullptr; }
    const Finding* main = &causes.front().finding;
    if (is_of_codes(*main)) { return main; }
    for (const FoundCause& cause : causes) {
        if (cause.finding.evidence_nats > main->evidence_nats) { main = &cause.finding; }
    }
    return main;
}

bool CauseSet::is_of_codes(const Finding& finding) { return traits_of(finding.effect).is_of_codes; }

bool CauseSet::is_huge(double evidence_nats) const {
    return 2.0 * options_.formulas_share * evidence_nats >= 1.0;
}

double CauseSet::evidence_least_nats() const {
    const Finding* main = main_cause();
    const double formulas_nats = main == nullptr ? 0.0 : options_.formulas_share * main->evidence_nats;
    return std::max(options_.evidence_min_nats, formulas_nats);
}

double CauseSet::evidence_less_bias_nats(const Finding& finding) const {
    return finding.evidence_nats - null_bias.of(finding);
}

double CauseSet::evidence_nats_of(const std::vector<std::size_t>& places) const {
    double nats = 0.0;
    for (const std::size_t i : places) { nats += causes[i].finding.evidence_nats; }
    return nats;
}

bool CauseSet::is_noise(const Finding& finding) const {
    return traits_of(finding.effect, *first_.prediction).is_noise;
}

bool CauseSet::is_fast_response(const Finding& finding) const {
    return traits_of(finding.effect, *first_.prediction).is_response &&
           !find_effect(finding.effect)->signature->slow;
}

std::vector<Finding> CauseSet::findings_of(const std::vector<std::optional<Finding>>& found) const {
    std::vector<Finding> findings;
    for (const std::optional<Finding>& finding : found) {
        if (!finding) { continue; }
        findings.push_back(*finding);
        findings.back().evidence_nats = evidence_less_bias_nats(*finding);
    }
    std::ranges::sort(findings, std::greater{}, &Finding::evidence_nats);
    return findings;
}

const Finding* CauseSet::further(const std::vector<std::optional<Finding>>& found) const {
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

std::vector<Finding> CauseSet::all_further(const std::vector<std::optional<Finding>>& found) const {
    std::map<EvidenceMethod, Finding> best;
    for (const Finding& finding : findings_of(found)) {
        if (finding.evidence_nats < evidence_least_nats()) { break; }
        if (!is_new(finding)) { continue; }
        best.try_emplace(traits_of(finding.effect, *first_.prediction).method, finding);
    }
    return best_first(std::move(best));
}

std::vector<Finding> CauseSet::best_first(std::map<EvidenceMethod, Finding> best) {
    std::vector<Finding> found;
    found.reserve(best.size());
    for (auto& [method, finding] : best) { found.push_back(std::move(finding)); }
    std::ranges::sort(found, std::greater{}, &Finding::evidence_nats);
    if (found.size() > resolution::tried_most) { found.resize(resolution::tried_most); }
    return found;
}

bool CauseSet::is_new(const Finding& finding) const {
    return !is_told_by_twin(finding) && std::ranges::none_of(causes, [&](const FoundCause& cause) {
        return is_same(cause.finding, finding);
    });
}

bool CauseSet::is_told_by_twin(const Finding& finding) const {
    const std::string_view twin = traits_of(finding.effect).twin;
    return !twin.empty() && finding.beside_nats() < decisions.strong_nats &&
           std::ranges::any_of(causes, [&](const FoundCause& cause) { return cause.finding.effect == twin; });
}

bool CauseSet::is_of_another(const Finding& finding, std::size_t own) const {
    if (is_same(causes[own].finding, finding)) { return false; }
    for (std::size_t i = 0; i < causes.size(); ++i) {
        if (i != own && is_same(causes[i].finding, finding)) { return true; }
    }
    return false;
}

std::optional<std::size_t> CauseSet::place_of(const Finding& finding) const {
    const auto same = std::ranges::find_if(
        causes, [&](const FoundCause& cause) { return is_same(cause.finding, finding); });
    if (same == causes.end()) { return std::nullopt; }
    return static_cast<std::size_t>(same - causes.begin());
}

double CauseSet::needed_nats(std::size_t cause) const {
    return &causes[cause].finding == main_cause() ? options_.evidence_min_nats : evidence_least_nats();
}

double CauseSet::own_nats(const Finding* again) const {
    return again == nullptr || is_told_by_twin(*again) ? 0.0 : again->evidence_nats;
}

const Finding* CauseSet::gives_way_to(std::size_t cause, const Finding* again,
                                      const std::vector<Finding>& found, const Hypotheses& beside_all) const {
    if (is_of_codes(causes[cause].finding) || (again != nullptr && is_of_another(*again, cause))) {
        return nullptr;
    }
    const Finding* rival = nullptr;
    double most_nats = std::max(own_nats(again) + decisions.strong_nats, needed_nats(cause));
    for (const Finding& one : found) {
        const double nats = null_bias.taken_over_nats(one, beside_all);
        if (is_new(one) && nats > most_nats) { rival = &one, most_nats = nats; }
    }
    return rival;
}

std::vector<Finding> CauseSet::rivals_of(const Finding& cause, const std::vector<Finding>& findings) const {
    std::vector<Finding> rivals;
    std::ranges::copy_if(findings, std::back_inserter(rivals), [&](const Finding& f) {
        return f.effect == cause.effect || (is_rival(f, cause) && !is_of_codes(cause));
    });
    return rivals;
}

std::size_t CauseSet::parameters_on(const Finding& finding, std::size_t axis) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(finding.entries.size(), finding.sd.size()); ++i) {
        if (acts_on(finding.entries[i], axis)) { count += finding.sd[i].size(); }
    }
    return count;
}

bool CauseSet::may_give_way(const Finding& cause, const Finding& rival) const {
    const EstimatorTraits& traits = traits_of(rival.effect, *first_.prediction);
    return rival.effect != cause.effect && !traits.is_beside_spectra && !traits.recurs &&
           !axes_to_give(cause, rival).empty();
}

std::vector<Finding> CauseSet::rivals_on_one_axis(const FoundCause& cause) const {
    const auto own = std::ranges::find(cause.rivals, cause.finding.effect, &Finding::effect);
    if (own == cause.rivals.end() || cause.finding.where.axes.size() < 2) { return {}; }
    std::vector<Finding> rivals;
    for (const std::size_t axis : cause.finding.where.axes) {
        const double least_nats = own->axis_gain_nats.at(axis) - decisions.strong_nats;
        for (const Finding& rival : cause.rivals) {
            if (rival.axis_gain_nats.at(axis) < least_nats) { continue; }
            if (parameters_on(rival, axis) >= parameters_on(cause.finding, axis)) { continue; }
            const std::optional<Finding> there = on_axes(rival, {axis});
            if (there && may_give_way(cause.finding, *there)) { rivals.push_back(*there); }
        }
    }
    return rivals;
}

std::vector<Finding> CauseSet::rivals_to_try(const FoundCause& cause) const {
    const EstimatorTraits& own = traits_of(cause.finding.effect);
    if (own.is_of_codes || own.recurs) { return {}; }
    const auto is_simpler = [&](const Finding& rival) {
        return rival.parameters < cause.finding.parameters &&
               rival.evidence_nats > cause.finding.evidence_nats;
    };
    std::map<EvidenceMethod, Finding> best;
    std::map<EvidenceMethod, Finding> simpler;
    for (const Finding& rival : cause.rivals) {
        if (!may_give_way(cause.finding, rival)) { continue; }
        const EvidenceMethod method = traits_of(rival.effect, *first_.prediction).method;
        if (best.try_emplace(method, rival).second || !is_simpler(rival)) { continue; }
        simpler.try_emplace(method, rival);
    }
    std::vector<Finding> rivals = best_first(std::move(best));
    for (auto& [method, rival] : simpler) { rivals.push_back(std::move(rival)); }
    std::ranges::move(rivals_on_one_axis(cause), std::back_inserter(rivals));
    return rivals;
}

int CauseSet::parameters(const std::vector<FoundCause>& some) {
    return std::accumulate(some.begin(), some.end(), 0,
                           [](int sum, const FoundCause& cause) { return sum + cause.finding.parameters; });
}

std::vector<std::size_t> CauseSet::axes_to_give(const Finding& cause, const Finding& rival) const {
    std::vector<std::size_t> axes;
    const auto same = std::ranges::find(causes, rival.effect, effect_name);
    for (const std::size_t axis : cause.where.axes) {
        if (rival.axis_gain_nats.at(axis) < decisions.seen_nats()) { continue; }
        if (std::ranges::count(rival.where.axes, axis) == 0) { continue; }
        if (same != causes.end() && std::ranges::count(same->finding.where.axes, axis) != 0) { continue; }
        axes.push_back(axis);
    }
    return axes;
}

bool CauseSet::give_to_rival(std::size_t place, const Finding& rival) {
    const Finding cause = causes[place].finding;
    const std::vector<std::size_t> given = axes_to_give(cause, rival);
    std::vector<std::size_t> kept;
    std::ranges::set_difference(cause.where.axes, given, std::back_inserter(kept));
    if (kept.empty() && traits_of(cause.effect).changes_likelihood) { return false; }
    std::vector<FoundCause> changed = causes;
    if (kept.empty()) {
        changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(place));
    } else {
        const std::optional<Finding> rest = on_axes(cause, kept);
        if (!rest) { return false; }
        changed[place].finding = *rest;
    }
    const bool is_whole = given.size() == rival.where.axes.size();
    const std::optional<Finding> taken = is_whole ? rival : on_axes(rival, given);
    if (!taken || !take_into(changed, *taken, kept.empty() ? place : changed.size())) { return false; }
    causes = std::move(changed);
    return true;
}

double CauseSet::worth_nats(const Observation& with_causes) const {
    return log_likelihood_nats(with_causes) + worth_beside_spectra_nats();
}

double CauseSet::worth_nats(const Hypotheses& with_causes, const Finding* next) const {
    if (next == nullptr) { return worth_nats(*with_causes.observation); }
    return worth_nats(
               with_causes.observation->under(with_open_cause(with_causes.prediction->model(), *next))) +
           worth_beside_spectra_nats(*next);
}

double CauseSet::worth_beside_spectra_nats() const {
    double nats = 0.0;
    for (const FoundCause& cause : causes) { nats += worth_beside_spectra_nats(cause.finding); }
    return nats;
}

double CauseSet::worth_beside_spectra_nats(const Finding& finding) {
    const EstimatorTraits& traits = traits_of(finding.effect);
    const bool is_told_beside = traits.is_beside_spectra || !traits.twin.empty();
    return finding.evidence_nats - (is_told_beside ? finding.spectral_nats() : finding.gain_nats);
}

std::set<std::string> CauseSet::change_likelihood_among(const std::vector<FoundCause>& some) {
    std::set<std::string> effects;
    for (const FoundCause& cause : some) {
        if (traits_of(cause.finding.effect).changes_likelihood) { effects.insert(cause.finding.effect); }
    }
    return effects;
}

std::vector<std::size_t> CauseSet::fast_responses() const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; first_.prediction->moves() && i < causes.size(); ++i) {
        if (is_fast_response(causes[i].finding)) { places.push_back(i); }
    }
    return places;
}

JointRefit CauseSet::fitted_together(const std::vector<std::size_t>& places, const Finding* more) const {
    SensorModel model = without_causes;
    std::vector<Finding> together;
    for (std::size_t i = 0; i < causes.size(); ++i) {
        if (std::ranges::count(places, i) != 0) {
            together.push_back(causes[i].finding);
        } else {
            model = with_open_cause(std::move(model), causes[i].finding);
        }
    }
    if (more != nullptr) { together.push_back(*more); }
    return refit_jointly(*first_.prediction->with(model), recording_, std::move(together), options_.seed);
}

bool CauseSet::settle_responses() {
    const std::vector<std::size_t> places = fast_responses();
    if (evidence_nats_of(places) < resolution::worth_settling_nats) { return false; }
    const JointRefit refit = fitted_together(places, nullptr);
    for (std::size_t i = 0; i < places.size(); ++i) { causes[places[i]].finding = refit.findings[i]; }
    return refit.moved;
}

void CauseSet::settle_spectra() {
    if (causes.size() < 2) { return; }  // its own estimator has fitted it
    std::vector<Finding> findings;
    for (const FoundCause& cause : causes) { findings.push_back(cause.finding); }
    // As the causes say it: noise that is unknown beside them would take up what they are fitted to.
    SensorModel model = without_causes;
    for (const Finding& finding : findings) { model = with_cause(std::move(model), finding); }
    const Observation seen(first_.prediction->with(model), recording_, options_.seed);
    findings = refit_spectra(seen, without_causes.effects.size(), std::move(findings));
    for (std::size_t i = 0; i < causes.size(); ++i) { causes[i].finding = std::move(findings[i]); }
}

bool CauseSet::leave_out_if_needless(std::size_t place, double with_it_nats) {
    const Finding& cause = causes[place].finding;
    if (is_of_codes(cause) || traits_of(cause.effect).changes_likelihood) { return false; }
    const std::vector<FoundCause> before = causes;
    causes.erase(causes.begin() + static_cast<std::ptrdiff_t>(place));
    settle_spectra();
    if (worth_nats(observed()) > with_it_nats - decisions.strong_nats) { return true; }
    causes = before;
    return false;
}

bool CauseSet::is_same(const Finding& a, const Finding& b) const {
    return is_same_cause(a, b, first_.prediction->duration_s());
}

bool CauseSet::is_rival(const Finding& finding, const Finding& cause) const {
    if (is_new(finding)) { return true; }
    if (traits_of(finding.effect).recurs || is_told_by_twin(finding)) { return false; }
    return !axes_to_give(cause, finding).empty();
}

}  // namespace gyrolog
