#include "analysis/diagnose/estimators/stamp_rate.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/lag.hpp"
#include "analysis/diagnose/estimators/stamp_evidence.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"

namespace gyrolog::resolution {

// No clock is known better, whatever a model says.
constexpr double clock_sd_rel_least = 1e-9;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// Entries act one after the other.
double log_rate_error(const EffectValues& values) { return std::log1p(values["rel"]); }

double expected_rate_hz(const Prediction& prediction, const EffectDefinition& effect) {
    const Recording& recording = prediction.world().recording();
    return recording.nominal_rate_hz.value_or(prediction.model().rate_hz) *
           std::exp(sum_in_stamps(prediction.model(), effect, log_rate_error));
}

Finding find_rate(const EffectDefinition& effect, const Prediction& prediction, double rel) {
    const Recording& recording = prediction.world().recording();
    const double stamps_sd = recording.rate_sd_hz.value_or(0.0) / recording.rate_hz;
    const double known_sd = std::max(resolution::clock_sd_rel_least, clock_rate_sd_rel(prediction.model()));
    const double sd = std::hypot(known_sd, stamps_sd);
    Finding finding =
        whole_sensor_finding(effect, prediction, {{"rel", rel}, {"in_stamps", 1.0}}, {{"rel", sd}});
    finding.gain_nats = std::min(resolution::certain_nats, 0.5 * rel * rel / (sd * sd));
    const auto range = std::ranges::find(effect.params, "rel", &EffectParam::name);
    finding.evidence_nats =
        finding.gain_nats - parameter_cost_nats(range->plausible_to - range->plausible_from, sd);
    return finding;
}

}  // namespace

MadeEstimator make_stamp_rate_estimator(const EffectDefinition& effect,
                                        std::shared_ptr<const Prediction> prediction) {
    const Recording& recording = prediction->world().recording();
    if (recording.stamps == StampKind::none) {
        return make_stamp_estimator({}, "the recording has no time stamps",
                                    make_lag_slope_estimator(effect, std::move(prediction)));
    }
    const double rel = recording.rate_hz / expected_rate_hz(*prediction, effect) - 1.0;
    if (std::fabs(rel) > decisions.clock_error_most) {
        return make_stamp_estimator({}, "the recording was taken at another rate than the model's",
                                    make_lag_slope_estimator(effect, std::move(prediction)));
    }
    std::optional<Finding> in_stamps = find_rate(effect, *prediction, rel);
    return make_stamp_estimator(std::move(in_stamps), {},
                                make_lag_slope_estimator(effect, std::move(prediction)));
}

}  // namespace gyrolog
