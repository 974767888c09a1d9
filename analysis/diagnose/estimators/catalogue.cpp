#include "analysis/diagnose/estimators/catalogue.hpp"

#include <algorithm>
#include <iterator>

#include "analysis/diagnose/estimators/ceiling_test.hpp"
#include "analysis/diagnose/estimators/code_grid_test.hpp"
#include "analysis/diagnose/estimators/line_test.hpp"
#include "analysis/diagnose/estimators/outlier_test.hpp"
#include "analysis/diagnose/estimators/repeat_test.hpp"
#include "analysis/diagnose/estimators/response_test.hpp"
#include "analysis/diagnose/estimators/shared_noise_test.hpp"
#include "analysis/diagnose/estimators/spectrum_test.hpp"
#include "analysis/diagnose/estimators/stamp_gap_test.hpp"
#include "analysis/diagnose/estimators/stamp_rate_test.hpp"
#include "analysis/diagnose/estimators/stamp_spread_test.hpp"
#include "analysis/diagnose/estimators/step_test.hpp"
#include "analysis/diagnose/estimators/tail_test.hpp"
#include "analysis/diagnose/estimators/two_level_test.hpp"
#include "analysis/diagnose/estimators/variance_course_test.hpp"
#include "analysis/diagnose/estimators/variance_of_test.hpp"
#include "analysis/diagnose/multiscale/means_model.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

namespace {

struct MethodMaker {
    EvidenceMethod method;
    TestMaker make;
};

constexpr MethodMaker makers[] = {
    {EvidenceMethod::response, make_response_test},
    {EvidenceMethod::spectrum, make_spectrum_test},
    {EvidenceMethod::line, make_line_test},
    {EvidenceMethod::step, make_step_test},
    {EvidenceMethod::two_levels, make_two_level_test},
    {EvidenceMethod::tails, make_tail_test},
    {EvidenceMethod::outliers, make_outlier_test},
    {EvidenceMethod::variance_course, make_variance_course_test},
    {EvidenceMethod::variance_of, make_variance_of_test},
    {EvidenceMethod::shared_noise, make_shared_noise_test},
    {EvidenceMethod::repeats, make_repeat_test},
    {EvidenceMethod::code_grid, make_code_grid_test},
    {EvidenceMethod::ceiling, make_ceiling_test},
    {EvidenceMethod::stamp_gaps, make_stamp_gap_test},
    {EvidenceMethod::stamp_rate, make_stamp_rate_test},
    {EvidenceMethod::stamp_spread, make_stamp_spread_test},
};

std::string lacking(const EffectSignature& signature, const Baseline& baseline) {
    if (signature.needs_temperature && baseline.temperature_C().empty()) {
        return "the recording has no temperature";
    }
    if (signature.needs_reference && !baseline.moves()) { return "the recording has no reference rate"; }
    if (signature.needs_specific_force && !baseline.world().has_specific_force()) {
        return "the recording has no specific force";
    }
    if (baseline.world().recording().samples_per_row > 1 && !shows_in_means(signature)) {
        return "means of several samples do not show it";
    }
    return {};
}

}  // namespace

EvidenceMethod evidence_method(const EffectSignature& signature, const Baseline& baseline) {
    return signature.changes_mean && baseline.moves() ? EvidenceMethod::response : signature.method;
}

MadeTest make_test(const EffectDefinition& effect, const std::shared_ptr<const Baseline>& baseline) {
    const EvidenceMethod method = evidence_method(*effect.signature, *baseline);
    const auto* maker = std::ranges::find(makers, method, &MethodMaker::method);
    return maker == std::end(makers) ? MadeTest{} : maker->make(effect, baseline);
}

std::vector<CatalogueEntry> make_catalogue(const std::shared_ptr<const Baseline>& baseline,
                                           unsigned threads) {
    std::vector<CatalogueEntry> catalogue;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        catalogue.push_back({link.effect, nullptr, lacking(*link.effect->signature, *baseline)});
    }
    parallel_for(catalogue.size(), threads, [&](std::size_t i) {
        CatalogueEntry& entry = catalogue[i];
        if (!entry.untestable.empty()) { return; }
        MadeTest made = make_test(*entry.effect, baseline);
        entry.test = std::move(made.test);
        entry.untestable = std::move(made.untestable);
    });
    return catalogue;
}

}  // namespace gyrolog
