#include "analysis/diagnose/estimators/catalogue.hpp"

#include <algorithm>
#include <iterator>

#include "analysis/diagnose/estimators/bias_step.hpp"
#include "analysis/diagnose/estimators/density_table.hpp"
#include "analysis/diagnose/estimators/disturbance.hpp"
#include "analysis/diagnose/estimators/line.hpp"
#include "analysis/diagnose/estimators/mean_response.hpp"
#include "analysis/diagnose/estimators/mean_table.hpp"
#include "analysis/diagnose/estimators/narrow_band.hpp"
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
#include "analysis/parallel/parallel_for.hpp"
#include "analysis/simulate/chain.hpp"

namespace gyrolog {

namespace {

constexpr EstimatorTraits no_estimator{};

constexpr EstimatorTraits rows[] = {
    {.method = EvidenceMethod::response,
     .make = make_mean_response_estimator,
     .is_response = true,
     .is_beside_noise = true},
    {.method = EvidenceMethod::spectrum, .make = make_noise_spectrum_estimator, .is_noise = true},
    {.method = EvidenceMethod::line,
     .make = make_line_estimator,
     .is_line = true,
     .recurs = true,
     .can_be_halved = false},
    {.method = EvidenceMethod::narrow_band,
     .make = make_narrow_band_estimator,
     .is_noise = true,
     .recurs = true},
    {.method = EvidenceMethod::step, .make = make_bias_step_estimator, .recurs = true},
    {.method = EvidenceMethod::random_telegraph,
     .make = make_random_telegraph_estimator,
     .twin = "gauss_markov",
     .is_noise = true,
     .is_not_normal = true,
     .can_be_halved = false},
    {.method = EvidenceMethod::tails,
     .far_off = FarOff::in_distribution,
     .make = make_tail_estimator,
     .is_noise = true,
     .is_not_normal = true,
     .changes_likelihood = true,
     .is_beside_spectra = true,
     .shows_in_means = false},
    {.method = EvidenceMethod::outliers,
     .far_off = FarOff::single_samples,
     .make = make_outlier_estimator,
     .is_not_normal = true,
     .changes_likelihood = true,
     .is_beside_spectra = true,
     .can_be_halved = false},
    {.method = EvidenceMethod::variance_change_point,
     .make = make_variance_change_point_estimator,
     .is_beside_spectra = true},
    {.method = EvidenceMethod::variance_with_temperature,
     .make = make_variance_with_temperature_estimator,
     .is_beside_spectra = true},
    {.method = EvidenceMethod::density_table,
     .make = make_density_table_estimator,
     .is_noise = true,
     .shows_in_means = false},
    {.method = EvidenceMethod::temperature_table,
     .make = make_temperature_table_estimator,
     .is_beside_noise = true},
    {.method = EvidenceMethod::rate_table, .make = make_rate_table_estimator, .is_beside_noise = true},
    {.method = EvidenceMethod::shared_noise, .make = make_shared_noise_estimator, .is_beside_spectra = true},
    {.method = EvidenceMethod::disturbances,
     .make = make_disturbance_estimator,
     .is_not_normal = true,
     .changes_likelihood = true,
     .is_beside_spectra = true,
     .shows_in_means = false,
     .can_be_halved = false},
    {.method = EvidenceMethod::repeats,
     .make = make_repeat_estimator,
     .changes_likelihood = true,
     .is_beside_spectra = true,
     .shows_in_means = false,
     .is_counted = true,
     .can_be_halved = false},
    {.method = EvidenceMethod::quantisation_step,
     .make = make_quantisation_step_estimator,
     .is_beside_spectra = true,
     .is_of_codes = true,
     .shows_in_means = false,
     .is_counted = true,
     .can_be_halved = false},
    {.method = EvidenceMethod::saturation,
     .make = make_saturation_estimator,
     .is_beside_noise = true,
     .changes_likelihood = true,
     .is_beside_spectra = true,
     .shows_in_means = false,
     .is_counted = true,
     .can_be_halved = false},
    {.method = EvidenceMethod::stamp_gaps,
     .make = make_stamp_gap_estimator,
     .is_beside_noise = true,
     .is_beside_spectra = true,
     .is_in_stamps = true,
     .shows_in_means = false,
     .is_counted = true,
     .can_be_halved = false},
    {.method = EvidenceMethod::stamp_rate,
     .make = make_stamp_rate_estimator,
     .is_beside_noise = true,
     .is_beside_spectra = true,
     .is_in_stamps = true,
     .shows_in_means = false,
     .can_be_halved = false},
    {.method = EvidenceMethod::stamp_jitter,
     .make = make_stamp_jitter_estimator,
     .is_beside_noise = true,
     .is_beside_spectra = true,
     .is_in_stamps = true,
     .shows_in_means = false,
     .can_be_halved = false},
};

const EstimatorTraits& row_of(EvidenceMethod method) {
    const auto* row = std::ranges::find(rows, method, &EstimatorTraits::method);
    return row == std::end(rows) ? no_estimator : *row;
}

EvidenceMethod evidence_method(const EffectSignature& signature, const Prediction& prediction) {
    return signature.changes_mean && prediction.moves() ? EvidenceMethod::response : signature.method;
}

std::string lacking(const EffectSignature& signature, const Prediction& prediction) {
    if (signature.needs_temperature && prediction.temperature_C().empty()) {
        return "the recording has no temperature";
    }
    if (signature.needs_reference && !prediction.moves()) { return "the recording has no reference rate"; }
    if (signature.needs_change && !prediction.world().reference_changes()) {
        return "the reference is constant wherever it is known";
    }
    if (!prediction.noise_is_sensors() && !row_of(evidence_method(signature, prediction)).is_beside_noise) {
        return "the error of the reference hides the sensor's noise";
    }
    if (signature.needs_specific_force && !prediction.world().has_specific_force()) {
        return "the recording has no specific force";
    }
    if (prediction.world().recording().samples_per_row > 1 && !shows_in_means(signature)) {
        return "means of several samples do not show it";
    }
    return {};
}

}  // namespace

const EstimatorTraits& traits_of(std::string_view effect) {
    const EffectSignature* signature = find_effect(effect)->signature;
    return signature == nullptr ? no_estimator : row_of(signature->method);
}

const EstimatorTraits& traits_of(std::string_view effect, const Prediction& prediction) {
    const EffectSignature* signature = find_effect(effect)->signature;
    return signature == nullptr ? no_estimator : row_of(evidence_method(*signature, prediction));
}

bool shows_in_means(const EffectSignature& signature) {
    return row_of(signature.method).shows_in_means && !signature.folds;
}

MadeEstimator make_estimator(const EffectDefinition& effect,
                             const std::shared_ptr<const Prediction>& prediction) {
    const EstimatorMaker make = row_of(evidence_method(*effect.signature, *prediction)).make;
    return make == nullptr ? MadeEstimator{} : make(effect, prediction);
}

std::string untestable_in(const EffectDefinition& effect, const Prediction& prediction) {
    return lacking(*effect.signature, prediction);
}

std::vector<CatalogueEntry> make_catalogue(const std::shared_ptr<const Prediction>& prediction,
                                           unsigned threads) {
    std::vector<CatalogueEntry> catalogue;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        if (!link.effect->form.empty()) { continue; }
        if (link.effect->signature->method == EvidenceMethod::described) { continue; }
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
