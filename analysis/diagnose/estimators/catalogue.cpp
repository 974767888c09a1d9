#include "analysis/diagnose/estimators/catalogue.hpp"

#include <algorithm>
#include <iterator>

#include "analysis/diagnose/estimators/bias_step.hpp"
#include "analysis/diagnose/estimators/line.hpp"
#include "analysis/diagnose/estimators/mean_response.hpp"
#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "analysis/diagnose/estimators/outliers.hpp"
#include "analysis/diagnose/estimators/quantisation_step.hpp"
#include "analysis/diagnose/estimators/random_telegraph.hpp"
#include "analysis/diagnose/estimators/repeats.hpp"
#include "analysis/diagnose/estimators/saturation.hpp"
#include "analysis/diagnose/estimators/shared_noise.hpp"
#include "analysis/diagnose/estimators/stamp_gaps.hpp"
#include "analysis/diagnose/estimators/stamp_jitter.hpp"
#include "analysis/diagnose/estimators/stamp_rate.hpp"
#include "analysis/diagnose/estimators/tails.hpp"
#include "analysis/diagnose/estimators/variance_change_point.hpp"
#include "analysis/diagnose/estimators/variance_with_temperature.hpp"
#include "analysis/diagnose/multiscale/means_model.hpp"
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

namespace {

struct MethodMaker {
    EvidenceMethod method;
    EstimatorMaker make;
};

constexpr MethodMaker makers[] = {
    {EvidenceMethod::response, make_mean_response_estimator},
    {EvidenceMethod::spectrum, make_noise_spectrum_estimator},
    {EvidenceMethod::line, make_line_estimator},
    {EvidenceMethod::step, make_bias_step_estimator},
    {EvidenceMethod::random_telegraph, make_random_telegraph_estimator},
    {EvidenceMethod::tails, make_tail_estimator},
    {EvidenceMethod::outliers, make_outlier_estimator},
    {EvidenceMethod::variance_change_point, make_variance_change_point_estimator},
    {EvidenceMethod::variance_with_temperature, make_variance_with_temperature_estimator},
    {EvidenceMethod::shared_noise, make_shared_noise_estimator},
    {EvidenceMethod::repeats, make_repeat_estimator},
    {EvidenceMethod::quantisation_step, make_quantisation_step_estimator},
    {EvidenceMethod::saturation, make_saturation_estimator},
    {EvidenceMethod::stamp_gaps, make_stamp_gap_estimator},
    {EvidenceMethod::stamp_rate, make_stamp_rate_estimator},
    {EvidenceMethod::stamp_jitter, make_stamp_jitter_estimator},
};

std::string lacking(const EffectSignature& signature, const Prediction& prediction) {
    if (signature.needs_temperature && prediction.temperature_C().empty()) {
        return "the recording has no temperature";
    }
    if (signature.needs_reference && !prediction.moves()) { return "the recording has no reference rate"; }
    if (signature.needs_specific_force && !prediction.world().has_specific_force()) {
        return "the recording has no specific force";
    }
    if (prediction.world().recording().samples_per_row > 1 && !shows_in_means(signature)) {
        return "means of several samples do not show it";
    }
    return {};
}

}  // namespace

EvidenceMethod evidence_method(const EffectSignature& signature, const Prediction& prediction) {
    return signature.changes_mean && prediction.moves() ? EvidenceMethod::response : signature.method;
}

MadeEstimator make_estimator(const EffectDefinition& effect,
                             const std::shared_ptr<const Prediction>& prediction) {
    const EvidenceMethod method = evidence_method(*effect.signature, *prediction);
    const auto* maker = std::ranges::find(makers, method, &MethodMaker::method);
    return maker == std::end(makers) ? MadeEstimator{} : maker->make(effect, prediction);
}

std::vector<CatalogueEntry> make_catalogue(const std::shared_ptr<const Prediction>& prediction,
                                           unsigned threads) {
    std::vector<CatalogueEntry> catalogue;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        catalogue.push_back({link.effect, nullptr, lacking(*link.effect->signature, *prediction)});
    }
    parallel_for(catalogue.size(), threads, [&](std::size_t i) {
        CatalogueEntry& entry = catalogue[i];
        if (!entry.untestable.empty()) { return; }
        MadeEstimator made = make_estimator(*entry.effect, prediction);
        entry.estimator = std::move(made.estimator);
        entry.untestable = std::move(made.untestable);
    });
    return catalogue;
}

}  // namespace gyrolog
