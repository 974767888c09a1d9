#include "analysis/diagnose/estimators/saturation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/diagnose/estimators/axis_fits.hpp"
#include "analysis/diagnose/estimators/mean_response.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog {

namespace {

// ln (Q(r) / phi(r)).
double log_mills_ratio(double r) {
    // Q underflows later than its expansion is right to a thousandth.
    if (r > 25.0) { return -std::log(r); }
    return std::log(0.5 * std::erfc(r / std::sqrt(2.0))) + 0.5 * r * r + 0.5 * std::log(2.0 * pi);
}

struct Pile {
    double at_rad_s = 0.0;
    std::vector<std::size_t> slots;
    std::vector<bool> negative;
};

class SaturationEstimator final : public Estimator {
public:
    SaturationEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction,
                        std::unique_ptr<Estimator> by_mean)
        : effect_(effect), prediction_(std::move(prediction)), by_mean_(std::move(by_mean)) {}

    std::optional<Finding> find(const Observation& observation) const override {
        std::optional<Finding> by_pile = found_by_pile(observation);
        std::optional<Finding> by_mean = by_mean_->find(observation);
        const bool pile = by_pile && (!by_mean || by_pile->evidence_nats > by_mean->evidence_nats);
        return pile ? by_pile : by_mean;
    }

private:
    std::optional<Finding> found_by_pile(const Observation& observation) const {
        const double lsb_rad_s = prediction_->model().lsb_rad_s;
        if (!(lsb_rad_s > 0.0)) { return std::nullopt; }
        std::vector<AxesFit> single;
        for (const std::size_t axis : prediction_->axes()) {
            // Printed decimals: nearer to this code than to the next.
            const Pile pile = highest(observation, axis, 0.5 * lsb_rad_s);
            if (pile.at_rad_s >= known_limit_rad_s(axis) - lsb_rad_s) { continue; }
            single.push_back(fit(observation, axis, pile));
        }
        std::optional<Finding> finding = best_of(effect_, single, 0.0, common(single, lsb_rad_s));
        if (finding) {
            const double limit_rad_s = finding->entries.front().params.at("limit_dps") * rad_per_deg;
            finding->where.rate_rad_s = {limit_rad_s, limit_rad_s};
        }
        return finding;
    }

    double known_limit_rad_s(std::size_t axis) const {
        double limit_rad_s = prediction_->model().saturation_rad_s;
        for (const EffectModel& entry : prediction_->model().effects) {
            if (entry.effect != effect_.name || !acts_on(entry, axis)) { continue; }
            limit_rad_s = std::min(limit_rad_s, EffectValues(entry, axis)["limit_dps"] * rad_per_deg);
        }
        return limit_rad_s;
    }

    // Of either sign.
    Pile highest(const Observation& observation, std::size_t axis, double tolerance_rad_s) const {
        const Recording& recording = observation.recording();
        const Column& column = *recording.find(gyro_columns[axis]);
        const std::int64_t origin = prediction_->world().recording().segments.front().first_index;
        Pile pile;
        for (const Segment& segment : recording.segments) {
            for (std::size_t i = 0; i < segment.count; ++i) {
                const auto slot = static_cast<std::size_t>(segment.first_index - origin) + i;
                if (slot >= prediction_->length()) { break; }
                const double rate_rad_s = column.value(segment.first + i);
                const double size_rad_s = std::fabs(rate_rad_s);
                if (size_rad_s < pile.at_rad_s - tolerance_rad_s || !observation.present()[slot]) {
                    continue;
                }
                if (size_rad_s > pile.at_rad_s + tolerance_rad_s) { pile = {size_rad_s, {}, {}}; }
                pile.slots.push_back(slot);
                pile.negative.push_back(rate_rad_s < 0.0);
            }
        }
        return pile;
    }

    AxesFit fit(const Observation& observation, std::size_t axis, const Pile& pile) const {
        const AxisObservation& seen = observation.axis(axis);
        const double lsb_rad_s = prediction_->model().lsb_rad_s;
        const double sigma_rad_s = std::sqrt(seen.density.back() * prediction_->rate_hz());
        double gain_nats = 0.0;
        for (std::size_t i = 0; i < pile.slots.size(); ++i) {
            const auto off = static_cast<double>(seen.residual_rad_s[pile.slots[i]]);
            gain_nats += log_mills_ratio((pile.negative[i] ? -off : off) / sigma_rad_s) +
                         std::log(sigma_rad_s / lsb_rad_s);
        }
        AxesFit fit;
        fit.axes = {axis};
        fit.gain_nats = {gain_nats};
        set_limit(fit, pile.at_rad_s);
        return fit;
    }

    void set_limit(AxesFit& fit, double limit_rad_s) const {
        const double limit_dps = limit_rad_s * deg_per_rad;
        const double sd_dps = prediction_->model().lsb_rad_s * deg_per_rad / std::sqrt(12.0);
        fit.params = {{"limit_dps", limit_dps}};
        fit.sd = {{"limit_dps", sd_dps}};
        fit.cost_nats = occam_cost_nats(param_of(effect_, "limit_dps"), limit_dps, sd_dps);
    }

    // All axes' limits, where they are one.
    std::optional<AxesFit> common(const std::vector<AxesFit>& single, double lsb_rad_s) const {
        if (single.size() < 2) { return std::nullopt; }
        AxesFit common;
        const double limit_rad_s = single.front().params.at("limit_dps") * rad_per_deg;
        for (const AxesFit& fit : single) {
            if (std::fabs(fit.params.at("limit_dps") * rad_per_deg - limit_rad_s) > lsb_rad_s) {
                return std::nullopt;
            }
            common.axes.push_back(fit.axes.front());
            common.gain_nats.push_back(fit.gain_nats.front());
        }
        set_limit(common, limit_rad_s);
        return common;
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    std::unique_ptr<Estimator> by_mean_;
};

}  // namespace

MadeEstimator make_saturation_estimator(const EffectDefinition& effect,
                                        std::shared_ptr<const Prediction> prediction) {
    MadeEstimator by_mean = make_mean_response_estimator(effect, prediction);
    if (!by_mean.estimator) { return by_mean; }
    return {
        std::make_unique<SaturationEstimator>(effect, std::move(prediction), std::move(by_mean.estimator)),
        {}};
}

}  // namespace gyrolog
