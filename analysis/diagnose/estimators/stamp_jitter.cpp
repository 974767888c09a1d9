#include "analysis/diagnose/estimators/stamp_jitter.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/sampling_jitter.hpp"
#include "analysis/diagnose/estimators/stamp_evidence.hpp"
#include "analysis/diagnose/estimators/stamp_scatter.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/numerics/golden_section.hpp"

namespace gyrolog {

namespace {

struct ExpectedJitter {
    double own_s = 0.0;     // the model's
    double sd_s = 0.0;      // of it
    double other_s2 = 0.0;  // known variance: rounding, effects that the model has
};

double scatter_log_likelihood_nats(const StampScatter& seen, double variance_s2) {
    return -0.5 * seen.independent * (std::log(variance_s2) + seen.sd_s * seen.sd_s / variance_s2);
}

// Of the sigma's distance z from the model's, in its standard deviations.
double best_without_nats(const StampScatter& seen, const ExpectedJitter& expected) {
    const auto nats = [&](double z) {
        const double own_s = std::max(0.0, expected.own_s + z * expected.sd_s);
        return scatter_log_likelihood_nats(seen, own_s * own_s + expected.other_s2) - 0.5 * z * z;
    };
    const double reach = std::sqrt(std::max(0.0, seen.sd_s * seen.sd_s - expected.other_s2)) - expected.own_s;
    return nats(place_of_top(nats, 0.0, std::max(0.0, reach / expected.sd_s)));
}

// Where the model states a jitter without its uncertainty: a usual MPU-9250's.
double default_jitter_sd_rel() { return typical_mpu9250().sd_rel.at("timestamp_jitter"); }

std::optional<Finding> find_spread(const EffectDefinition& effect, const Prediction& prediction,
                                   const StampScatter& seen) {
    const SensorModel& model = prediction.model();
    ExpectedJitter expected;
    expected.own_s = model.timestamp_jitter_s;
    expected.sd_s =
        model.timestamp_jitter_s > 0.0
            ? model.timestamp_jitter_s * std::max(1e-6, stated_uncertainty(model.sd_rel, "timestamp_jitter",
                                                                           default_jitter_sd_rel()))
            : decisions.unstated_jitter_s;
    // Errors of rounding may alternate from stamp to stamp: their second differences then have up to 16/6 of
    // the variance of independent ones.
    expected.other_s2 = 2.0 / 9.0 * seen.resolution_s * seen.resolution_s + 1e-20 +
                        sum_in_stamps(model, effect, [](const EffectValues& values) {
                            return values["sd_s"] * values["sd_s"];
                        });
    const double excess_s2 = seen.sd_s * seen.sd_s - expected.own_s * expected.own_s - expected.other_s2;
    if (excess_s2 <= 0.0) { return std::nullopt; }
    const double added_s = std::sqrt(excess_s2);
    const double added_sd_s = std::hypot(std::sqrt(2.0 / seen.independent) * seen.sd_s * seen.sd_s,
                                         2.0 * expected.own_s * expected.sd_s) /
                              (2.0 * added_s);
    Finding finding = whole_sensor_finding(effect, prediction, {{"sd_s", added_s}, {"in_stamps", 1.0}},
                                           {{"sd_s", added_sd_s}});
    finding.gain_nats = std::clamp(
        scatter_log_likelihood_nats(seen, seen.sd_s * seen.sd_s) - best_without_nats(seen, expected), 0.0,
        resolution::certain_nats);
    const auto range = std::ranges::find(effect.params, "sd_s", &EffectParam::name);
    finding.evidence_nats =
        finding.gain_nats - parameter_cost_nats(std::log(range->plausible_to / range->plausible_from),
                                                std::min(1.0, added_sd_s / added_s));
    return finding;
}

}  // namespace

MadeEstimator make_stamp_jitter_estimator(const EffectDefinition& effect,
                                          std::shared_ptr<const Prediction> prediction) {
    const Recording& recording = prediction->world().recording();
    if (recording.stamps == StampKind::none) {
        return make_stamp_estimator({}, "the recording has no time stamps",
                                    make_sampling_jitter_estimator(effect, std::move(prediction)));
    }
    const std::optional<StampScatter> seen = stamp_scatter(recording);
    if (!seen) {
        return make_stamp_estimator({}, "the samples have no time stamps of their own",
                                    make_sampling_jitter_estimator(effect, std::move(prediction)));
    }
    if (recording.stamps == StampKind::arrival && seen->neighbour_correlation > decisions.burst_correlation) {
        return make_stamp_estimator({}, "the time stamps are arrival times that come in bursts",
                                    make_sampling_jitter_estimator(effect, std::move(prediction)));
    }
    std::optional<Finding> in_stamps = find_spread(effect, *prediction, *seen);
    return make_stamp_estimator(std::move(in_stamps), {},
                                make_sampling_jitter_estimator(effect, std::move(prediction)));
}

}  // namespace gyrolog
