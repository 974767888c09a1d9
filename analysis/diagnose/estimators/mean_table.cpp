#include "analysis/diagnose/estimators/mean_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "analysis/diagnose/likelihood/mean_regression.hpp"
#include "analysis/numerics/cosine_transform.hpp"

namespace gyrolog::resolution {

constexpr std::array<std::size_t, 3> knots_tried = {3, 5, 9};

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// By slot: what the mean may be a course of.
struct Argument {
    std::vector<double> of_slot;
    std::optional<Span> rate_rad_s;  // of a rate: the sizes that there are

    double least() const { return *std::ranges::min_element(of_slot); }
    double most() const { return *std::ranges::max_element(of_slot); }
};

using ArgumentOf = Argument (*)(const Prediction& prediction, std::size_t axis);

Argument temperature_of(const Prediction& prediction, std::size_t /*axis*/) {
    const std::vector<float>& temperature_C = prediction.temperature_C();
    return {{temperature_C.begin(), temperature_C.end()}, {}};
}

Argument rate_of(const Prediction& prediction, std::size_t axis) {
    Argument rate;
    double most_rad_s = 0.0;
    for (const float each : prediction.true_rate_rad_s(axis)) {
        const auto rate_rad_s = static_cast<double>(each);
        rate.of_slot.push_back(rate_rad_s * deg_per_rad);
        most_rad_s = std::max(most_rad_s, std::fabs(rate_rad_s));
    }
    rate.rate_rad_s = Span{0.0, most_rad_s};
    return rate;
}

// One axis' course with so many knots.
struct Fit {
    std::vector<double> at;
    std::vector<double> value_rad_s;
    double gain_nats = 0.0;
    double evidence_nats = 0.0;
};

class MeanTableEstimator final : public Estimator {
public:
    MeanTableEstimator(const EffectDefinition& effect, std::shared_ptr<const Prediction> prediction,
                       ArgumentOf argument_of)
        : effect_(effect), prediction_(std::move(prediction)) {
        for (const std::size_t axis : prediction_->axes()) {
            arguments_[axis] = argument_of(*prediction_, axis);
        }
    }

    std::optional<Finding> find(const Observation& observation) const override {
        Finding finding;
        finding.effect = effect_.name;
        for (const std::size_t axis : prediction_->axes()) {
            const std::optional<Fit> best = best_fit(observation, axis);
            if (best) { add(*best, axis, finding); }
        }
        if (finding.entries.empty()) { return std::nullopt; }
        finding.where.temperature = effect_.signature->place == PlaceKind::temperature;
        return finding;
    }

private:
    std::optional<Fit> best_fit(const Observation& observation, std::size_t axis) const {
        std::optional<Fit> best;
        if (!(arguments_[axis].least() < arguments_[axis].most())) { return best; }
        for (const std::size_t knots : resolution::knots_tried) {
            Fit fit = fitted(observation, axis, knots);
            if (fit.evidence_nats > (best ? best->evidence_nats : 0.0)) { best = std::move(fit); }
        }
        return best;
    }

    Fit fitted(const Observation& observation, std::size_t axis, std::size_t knots) const {
        Fit fit;
        const Argument& argument = arguments_[axis];
        const double step = (argument.most() - argument.least()) / static_cast<double>(knots - 1);
        for (std::size_t k = 0; k < knots; ++k) {
            fit.at.push_back(argument.least() + static_cast<double>(k) * step);
        }
        const MeanResponses responses(*prediction_, axis, hat_cosines(argument, fit.at));
        const MeanRegression regression(observation, axis, responses);
        const NormalEquations equations = regression.equations(observation.axis(axis).density);
        fit.value_rad_s = equations.solution();
        fit.gain_nats = equations.gain_nats(fit.value_rad_s);
        fit.evidence_nats = fit.gain_nats - cost_nats(knots);
        fit.value_rad_s.insert(fit.value_rad_s.begin(), 0.0);
        take_mean_off(argument, fit);
        return fit;
    }

    // The bias is the model's.
    static void take_mean_off(const Argument& argument, Fit& fit) {
        const Course course(fit.at, fit.value_rad_s);
        double sum = 0.0;
        for (const double each : argument.of_slot) { sum += course(each); }
        const double mean = sum / static_cast<double>(argument.of_slot.size());
        for (double& value : fit.value_rad_s) { value -= mean; }
    }

    // Of each knot's straight way up from its neighbours and down again; the first knot's is what a bias and
    // the others make.
    std::vector<std::vector<float>> hat_cosines(const Argument& argument,
                                                const std::vector<double>& at) const {
        const TransformPool::Lease transform = prediction_->transform();
        const double step = at[1] - at[0];
        std::vector<std::vector<float>> cosines;
        for (const double knot : std::span(at).subspan(1)) {
            std::vector<double> hat(prediction_->length());
            for (std::size_t slot = 0; slot < hat.size(); ++slot) {
                hat[slot] = std::max(1.0 - std::fabs(argument.of_slot[slot] - knot) / step, 0.0);
            }
            transform->forward(hat);
            hat[0] = 0.0;
            cosines.emplace_back(hat.begin(), hat.end());
        }
        return cosines;
    }

    double cost_nats(std::size_t knots) const {
        double coefficients = 0.0;
        for (const SpectralBin& bin : prediction_->bins()) { coefficients += bin.count(); }
        return 0.5 * static_cast<double>(knots - 1) * std::log(coefficients);
    }

    void add(const Fit& fit, std::size_t axis, Finding& finding) const {
        EffectModel entry{std::string(effect_.name), {axis_names.at(axis)}, {}, ""};
        entry.table[std::string(effect_.table->at)] = fit.at;
        std::vector<double>& value_dps = entry.table[std::string(effect_.table->value)];
        for (const double value_rad_s : fit.value_rad_s) { value_dps.push_back(value_rad_s * deg_per_rad); }
        finding.entries.push_back(std::move(entry));
        finding.sd.emplace_back();
        finding.axis_gain_nats.at(axis) = fit.gain_nats;
        finding.gain_nats += fit.gain_nats;
        finding.evidence_nats += fit.evidence_nats;
        finding.where.axes.push_back(axis);
        if (arguments_[axis].rate_rad_s) {
            const double before = finding.where.rate_rad_s ? finding.where.rate_rad_s->to : 0.0;
            finding.where.rate_rad_s = Span{0.0, std::max(before, arguments_[axis].rate_rad_s->to)};
        }
    }

    const EffectDefinition& effect_;
    std::shared_ptr<const Prediction> prediction_;
    std::array<Argument, 3> arguments_;
};

}  // namespace

MadeEstimator make_temperature_table_estimator(const EffectDefinition& effect,
                                               std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<MeanTableEstimator>(effect, std::move(prediction), temperature_of), {}};
}

MadeEstimator make_rate_table_estimator(const EffectDefinition& effect,
                                        std::shared_ptr<const Prediction> prediction) {
    return {std::make_unique<MeanTableEstimator>(effect, std::move(prediction), rate_of), {}};
}

}  // namespace gyrolog
