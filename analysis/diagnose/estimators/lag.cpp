#include "analysis/diagnose/estimators/lag.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/diagnose/estimators/resolutions.hpp"
#include "analysis/diagnose/estimators/stamp_evidence.hpp"
#include "analysis/diagnose/likelihood/lag_course.hpp"
#include "analysis/diagnose/likelihood/occam.hpp"
#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

namespace {

constexpr std::string_view place = "growing_lag";

const EffectParam& param(const EffectDefinition& effect, std::string_view name) {
    return *std::ranges::find(effect.params, name, &EffectParam::name);
}

// A wrong timing leaves a residual, or pulls the clock's or the latency's uncertainty.
bool may_be_mistimed(const Observation& observation) {
    double squares = 0.0;
    double count = 0.0;
    for (const std::size_t axis : observation.prediction().axes()) {
        if (uncertain_charge_nats(observation, axis) > decisions.seen_nats()) { return true; }
        for (const float white : observation.axis(axis).whitened) {
            squares += static_cast<double>(white) * static_cast<double>(white);
        }
        count += static_cast<double>(observation.axis(axis).whitened.size());
    }
    return squares / count - 1.0 > decisions.seen_sigma * std::sqrt(2.0 / count);
}

class LagEstimator : public Estimator {
public:
    LagEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(&effect), prediction_(std::move(prediction)) {}

    std::optional<Finding> find(const Observation& observation) const override {
        if (!may_be_mistimed(observation)) { return std::nullopt; }
        std::optional<Finding> finding = proposed(LagCourse(*prediction_, observation.recording()));
        if (!finding) { return std::nullopt; }
        SensorModel model = prediction_->model();
        model.effects.push_back(finding->entries.front());
        const Observation with = observation.under(model);
        finding->where.structure = place;
        finding->gain_nats = log_likelihood_nats(with) - log_likelihood_nats(observation);
        if (finding->gain_nats < resolution::worth_refining_nats) { return std::nullopt; }
        // Until here, what the freedom of the parameters costs, below zero.
        finding->evidence_nats += finding->gain_nats;
        return finding;
    }

protected:
    const EffectDefinition& effect() const { return *effect_; }
    const Prediction& prediction() const { return *prediction_; }

private:
    virtual std::optional<Finding> proposed(const LagCourse& course) const = 0;

    const EffectDefinition* effect_;
    std::shared_ptr<const Prediction> prediction_;
};

class LagSlopeEstimator final : public LagEstimator {
public:
    using LagEstimator::LagEstimator;

private:
    std::optional<Finding> proposed(const LagCourse& course) const override {
        const LagSlope slope = course.slope();
        // A sensor that runs fast by rel shows moments that fall behind its stamps.
        const double rel = -slope.rel / (1.0 + slope.rel);
        // What the model's own uncertainty covers has been taken off already.
        const double known_sd = clock_rate_sd_rel(prediction().model());
        if (std::fabs(rel) < 3.0 * known_sd) { return std::nullopt; }
        Finding finding = whole_sensor_finding(effect(), prediction(), {{"rel", rel}, {"in_stamps", 0.0}},
                                               {{"rel", slope.sd}});
        const EffectParam& range = param(effect(), "rel");
        finding.evidence_nats = -parameter_cost_nats(range.plausible_to - range.plausible_from, slope.sd);
        return finding;
    }
};

class LagStepEstimator final : public LagEstimator {
public:
    using LagEstimator::LagEstimator;

private:
    std::optional<Finding> proposed(const LagCourse& course) const override {
        for (const EffectModel& entry : prediction().model().effects) {
            if (entry.effect == effect().name && EffectValues(entry)["in_stamps"] == 0.0) {
                return std::nullopt;  // an observation under it has its steps taken out
            }
        }
        const std::vector<LagStep> steps = course.steps();
        if (steps.empty()) { return std::nullopt; }
        const double hours = prediction().duration_s() / s_per_h;
        const auto count = static_cast<double>(steps.size());
        const int longest = std::ranges::max(steps, {}, &LagStep::samples).samples;
        Finding finding = whole_sensor_finding(
            effect(), prediction(), {{"per_hour", count / hours}, {"longest", longest}, {"in_stamps", 0.0}},
            {{"per_hour", std::sqrt(count) / hours}, {"longest", longest / (count + 1.0)}});
        if (steps.size() == 1) {
            const double at_s = static_cast<double>(steps.front().slot) / prediction().rate_hz();
            finding.where.time_s = {at_s, at_s};
        }
        // Each may be anywhere, and of any length.
        finding.evidence_nats = -count * std::log(param(effect(), "longest").plausible_to *
                                                  static_cast<double>(prediction().length()));
        return finding;
    }
};

}  // namespace

std::unique_ptr<Estimator> make_lag_slope_estimator(const EffectDefinition& effect,
                                                    std::shared_ptr<const Prediction> prediction) {
    if (!prediction->moves()) { return nullptr; }
    return std::make_unique<LagSlopeEstimator>(effect, std::move(prediction));
}

std::unique_ptr<Estimator> make_lag_step_estimator(const EffectDefinition& effect,
                                                   std::shared_ptr<const Prediction> prediction) {
    if (!prediction->moves()) { return nullptr; }
    return std::make_unique<LagStepEstimator>(effect, std::move(prediction));
}

}  // namespace gyrolog
