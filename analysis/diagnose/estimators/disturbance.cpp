#include "analysis/diagnose/estimators/disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/stamp_evidence.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/effects/disturbance.hpp"

namespace gyrolog {
namespace {

// A model that has them leaves them out already.
bool has_disturbances(const SensorModel& model, const EffectDefinition& effect) {
    return std::ranges::any_of(model.effects,
                               [&](const EffectModel& entry) { return entry.effect == effect.name; });
}

class DisturbanceEstimator final : public Estimator {
public:
    DisturbanceEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction)
        : effect_(effect), prediction_(std::move(prediction)) {}

    std::optional<Finding> find(const Observation& observation) const override {
        if (has_disturbances(prediction_->model(), effect_)) { return std::nullopt; }
        const std::vector<Disturbance> found = gyro_disturbances(observation.recording());
        if (found.empty()) { return std::nullopt; }
        const auto count = static_cast<double>(found.size());
        double size_rad_s = 0.0;
        double together_s = 0.0;
        double gain_nats = 0.0;
        const Disturbance* clearest = &found.front();
        for (const Disturbance& one : found) {
            size_rad_s = std::max(size_rad_s, one.largest);
            together_s += one.to_s - one.from_s;
            for (const double nats : one.gain_nats) { gain_nats += nats; }
            if (one.largest > clearest->largest) { clearest = &one; }
        }
        const double per_hour = count * s_per_h / prediction_->duration_s();
        const double mean_s = together_s / count;
        // One bump's size and length say nothing about the spread of others'.
        Finding finding = whole_sensor_finding(effect_, *prediction_,
                                               {{"per_hour", per_hour},
                                                {"size_dps", size_rad_s / rad_per_deg},
                                                {"decay_s", mean_s},
                                                {"simulated", 0.0}},
                                               {{"per_hour", per_hour / std::sqrt(count)}});
        finding.gain_nats = gain_nats;
        finding.evidence_nats =
            gain_nats - occam_cost_nats(param_of(effect_, "per_hour"), per_hour, per_hour / std::sqrt(count));
        finding.where.time_s = Span{clearest->from_s, clearest->to_s};
        for (std::size_t i = 0; i < prediction_->axes().size(); ++i) {
            for (const Disturbance& one : found) {
                finding.axis_gain_nats[prediction_->axes()[i]] += one.gain_nats[i];
            }
        }
        return finding;
    }

private:
    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
};

}  // namespace

MadeEstimator make_disturbance_estimator(const EffectDefinition& effect,
                                         std::shared_ptr<const Prediction> prediction) {
    if (prediction->moves()) { return {}; }
    return {std::make_unique<DisturbanceEstimator>(effect, std::move(prediction)), {}};
}

}  // namespace gyrolog
