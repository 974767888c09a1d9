#include "analysis/diagnose/estimators/stamp_evidence.hpp"

#include <algorithm>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

namespace {

class StampEstimator final : public Estimator {
public:
    StampEstimator(std::optional<Finding> in_stamps, std::unique_ptr<Estimator> in_samples)
        : in_stamps_(std::move(in_stamps)), in_samples_(std::move(in_samples)) {}

    std::optional<Finding> find(const Observation& observation) const override {
        std::optional<Finding> best;
        if (in_samples_) { best = in_samples_->find(observation); }
        if (!in_stamps_ || !has_own_stamps(observation)) { return best; }
        if (best && best->evidence_nats > in_stamps_->evidence_nats) { return best; }
        return in_stamps_;
    }

private:
    std::optional<Finding> in_stamps_;
    std::unique_ptr<Estimator> in_samples_;
};

}  // namespace

bool has_own_stamps(const Observation& observation) {
    return &observation.recording() == &observation.prediction().world().recording();
}

double stated_uncertainty(const std::map<std::string, double>& stated, const char* name, double otherwise) {
    const auto found = stated.find(name);
    return found == stated.end() ? otherwise : found->second;
}

double sum_in_stamps(const SensorModel& model, const EffectDefinition& effect,
                     double (*term)(const EffectValues&)) {
    double sum = 0.0;
    for (const EffectModel& entry : model.effects) {
        if (entry.effect != effect.name) { continue; }
        const EffectValues values(entry);
        if (values["in_stamps"] != 0.0) { sum += term(values); }
    }
    return sum;
}

Finding whole_sensor_finding(const EffectDefinition& effect, const Prediction& prediction,
                             std::map<std::string, double> params, std::map<std::string, double> sd) {
    Finding finding;
    finding.effect = effect.name;
    finding.parameters = static_cast<int>(sd.size());
    EffectModel entry{
        .effect = std::string(effect.name), .axes = {}, .params = std::move(params), .carried_json = {}};
    for (const std::size_t axis : prediction.axes()) { entry.axes.emplace_back(axis_names[axis]); }
    finding.entries.push_back(std::move(entry));
    finding.sd.push_back(std::move(sd));
    finding.where.axes = prediction.axes();
    finding.where.structure = effect.signature->structure;
    return finding;
}

MadeEstimator make_stamp_estimator(std::optional<Finding> in_stamps, std::string stamps_untestable,
                                   std::unique_ptr<Estimator> in_samples) {
    if (!stamps_untestable.empty() && !in_samples) { return {nullptr, std::move(stamps_untestable)}; }
    return {std::make_unique<StampEstimator>(std::move(in_stamps), std::move(in_samples)), {}};
}

}  // namespace gyrolog
