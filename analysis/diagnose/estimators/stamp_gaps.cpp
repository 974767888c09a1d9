#include "analysis/diagnose/estimators/stamp_gaps.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/lag.hpp"
#include "analysis/diagnose/estimators/stamp_evidence.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

namespace {

struct Gaps {
    double count = 0.0;
    double longest = 0.0;
    double delivered_h = 0.0;
    std::vector<double> lengths;
};

Gaps gaps_of(const Recording& recording) {
    Gaps gaps;
    gaps.delivered_h = static_cast<double>(recording.rows()) / (recording.rate_hz * s_per_h);
    for (const Dropout& dropout : recording.dropouts) {
        if (dropout.cause == "empty_fields") { continue; }  // their rows are there
        const auto length = static_cast<double>(dropout.samples);
        gaps.count += 1.0;
        gaps.longest = std::max(gaps.longest, length);
        gaps.lengths.push_back(length);
    }
    return gaps;
}

struct Expected {
    double per_hour = 0.0;
    double longest = 0.0;
};

Expected expected_of(const SensorModel& model, const EffectDefinition& effect) {
    Expected expected;
    expected.per_hour =
        std::max(decisions.unexpected_gaps_per_h,
                 sum_in_stamps(model, effect, [](const EffectValues& values) { return values["per_hour"]; }));
    for (const EffectModel& entry : model.effects) {
        if (entry.effect == effect.name) {
            expected.longest = std::max(expected.longest, EffectValues(entry)["longest"]);
        }
    }
    return expected;
}

double length_gain_nats(const Gaps& gaps, double expected_longest) {
    if (expected_longest == 0.0) { return 0.0; }
    // What the model says does not happen happens as seldom as a false alarm.
    const double too_long_probability = decisions.false_alarms_most;
    double gain_nats = 0.0;
    for (const double length : gaps.lengths) {
        const double expected = length <= expected_longest ? (1.0 - too_long_probability) / expected_longest
                                                           : too_long_probability / gaps.longest;
        gain_nats += std::log(1.0 / (gaps.longest * expected));
    }
    return std::max(0.0, gain_nats);
}

std::optional<Finding> find_gaps(const EffectDefinition& effect, const Prediction& prediction) {
    const Gaps gaps = gaps_of(prediction.world().recording());
    const Expected expected = expected_of(prediction.model(), effect);
    if (gaps.count == 0.0) { return std::nullopt; }
    const double expected_count = expected.per_hour * gaps.delivered_h;
    const double rate_gain_nats =
        gaps.count * std::log(gaps.count / expected_count) - (gaps.count - expected_count);
    const double per_hour = gaps.count / gaps.delivered_h;
    const double longest = std::min(gaps.longest, 1e6);
    Finding finding = whole_sensor_finding(
        effect, prediction, {{"per_hour", per_hour}, {"longest", longest}, {"in_stamps", 1.0}},
        {{"per_hour", per_hour / std::sqrt(gaps.count)}, {"longest", longest / (gaps.count + 1.0)}});
    finding.gain_nats =
        std::min(resolution::certain_nats, rate_gain_nats + length_gain_nats(gaps, expected.longest));
    const auto per_hour_range = std::ranges::find(effect.params, "per_hour", &EffectParam::name);
    finding.evidence_nats =
        finding.gain_nats -
        parameter_cost_nats(std::log(per_hour_range->plausible_to / per_hour_range->plausible_from),
                            1.0 / std::sqrt(gaps.count));
    return finding;
}

}  // namespace

MadeEstimator make_stamp_gap_estimator(const EffectDefinition& effect,
                                       std::shared_ptr<const Prediction> prediction) {
    const Recording& recording = prediction->world().recording();
    if (recording.stamps == StampKind::none) {
        return make_stamp_estimator({}, "the recording has no time stamps",
                                    make_lag_step_estimator(effect, std::move(prediction)));
    }
    if (recording.stamps == StampKind::arrival) {
        return make_stamp_estimator({}, "the time stamps are arrival times: they show no gaps",
                                    make_lag_step_estimator(effect, std::move(prediction)));
    }
    std::optional<Finding> in_stamps = find_gaps(effect, *prediction);
    return make_stamp_estimator(std::move(in_stamps), {},
                                make_lag_step_estimator(effect, std::move(prediction)));
}

}  // namespace gyrolog
