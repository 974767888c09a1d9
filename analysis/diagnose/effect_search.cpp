#include "analysis/diagnose/effect_search.hpp"

#include <algorithm>

#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

namespace {

class Search {
public:
    Search(const Hypotheses& first, std::shared_ptr<const Recording> recording, const SearchOptions& options)
        : first_(first), recording_(std::move(recording)), options_(options) {}

    std::optional<EffectSearchResult> run() {
        const Hypotheses* now = &first_;
        Hypotheses latest;
        while (causes_.size() < options_.causes_most) {
            const Finding* next = further(*now);
            if (next == nullptr || next->evidence_nats < options_.evidence_min_nats) { break; }
            causes_.push_back({*next, findings_of(*now)});
            if (!told()) { return std::nullopt; }
            if (causes_.size() > 1 && !refit()) { return std::nullopt; }
            latest = examine(first_.baseline->with(model_with_all_but(causes_.size())), recording_,
                             options_.seed, options_.threads);
            now = &latest;
        }
        EffectSearchResult result;
        result.corrected = model_with_all_but(causes_.size());
        result.causes = std::move(causes_);
        std::ranges::sort(result.causes, std::greater{},
                          [](const FoundCause& cause) { return cause.finding.evidence_nats; });
        if (now == &latest) {
            result.last = std::move(latest);
        } else {
            result.last = {first_.baseline, first_.observation, {}, {}};
        }
        return result;
    }

private:
    bool told() const {
        const double share =
            static_cast<double>(causes_.size()) / static_cast<double>(options_.causes_most + 1);
        return !options_.on_progress || options_.on_progress(share);
    }

    static std::vector<Finding> findings_of(const Hypotheses& hypotheses) {
        std::vector<Finding> findings;
        for (const std::optional<Finding>& finding : hypotheses.findings) {
            if (finding) { findings.push_back(*finding); }
        }
        std::ranges::sort(findings, std::greater{}, &Finding::evidence_nats);
        return findings;
    }

    bool repeats_itself(const Finding& finding) const {
        const EvidenceMethod method = find_effect(finding.effect)->signature->method;
        return method == EvidenceMethod::line || method == EvidenceMethod::step;
    }

    // The best finding that is not of an effect found before: what those could explain, their fit has.
    const Finding* further(const Hypotheses& hypotheses) const {
        const Finding* best = nullptr;
        for (const std::optional<Finding>& finding : hypotheses.findings) {
            if (!finding) { continue; }
            const bool known = std::ranges::any_of(
                causes_, [&](const FoundCause& cause) { return cause.finding.effect == finding->effect; });
            if (known && !repeats_itself(*finding)) { continue; }
            if (best == nullptr || finding->evidence_nats > best->evidence_nats) { best = &*finding; }
        }
        return best;
    }

    SensorModel model_with_all_but(std::size_t left_out) const {
        SensorModel model = first_.baseline->model();
        for (std::size_t i = 0; i < causes_.size(); ++i) {
            if (i != left_out) { model = with_cause(std::move(model), causes_[i].finding); }
        }
        return model;
    }

    // Every cause with the others in the model.
    bool refit() {
        for (std::size_t i = 0; i < causes_.size();) {
            const Hypotheses without = examine(first_.baseline->with(model_with_all_but(i)), recording_,
                                               options_.seed, options_.threads);
            const std::vector<Finding> findings = findings_of(without);
            const auto same = std::ranges::find(findings, causes_[i].finding.effect, &Finding::effect);
            if (same == findings.end() || same->evidence_nats < options_.evidence_min_nats) {
                causes_.erase(causes_.begin() + static_cast<std::ptrdiff_t>(i));
                continue;
            }
            causes_[i].finding = *same;
            causes_[i].rivals = findings;
            ++i;
            if (!told()) { return false; }
        }
        return true;
    }

    const Hypotheses& first_;
    std::shared_ptr<const Recording> recording_;
    SearchOptions options_;
    std::vector<FoundCause> causes_;
};

}  // namespace

const Finding* Hypotheses::best() const {
    const Finding* best = nullptr;
    for (const std::optional<Finding>& finding : findings) {
        if (finding && (best == nullptr || finding->evidence_nats > best->evidence_nats)) {
            best = &*finding;
        }
    }
    return best;
}

Hypotheses examine(const std::shared_ptr<const Baseline>& baseline,
                   const std::shared_ptr<const Recording>& recording, std::uint64_t seed, unsigned threads) {
    Hypotheses hypotheses;
    hypotheses.baseline = baseline;
    hypotheses.observation = std::make_shared<const Observation>(baseline, recording, seed);
    hypotheses.catalogue = make_catalogue(baseline, threads);
    hypotheses.findings.resize(hypotheses.catalogue.size());
    parallel_for(hypotheses.catalogue.size(), threads, [&](std::size_t i) {
        if (hypotheses.catalogue[i].test) {
            hypotheses.findings[i] = hypotheses.catalogue[i].test->find(*hypotheses.observation);
        }
    });
    return hypotheses;
}

std::optional<EffectSearchResult> search_effects(const Hypotheses& first,
                                                 const std::shared_ptr<const Recording>& recording,
                                                 const SearchOptions& options) {
    return Search(first, recording, options).run();
}

SensorModel with_cause(SensorModel model, const Finding& finding) {
    for (const EffectModel& entry : finding.entries) { model.effects.push_back(entry); }
    return model;
}

}  // namespace gyrolog
