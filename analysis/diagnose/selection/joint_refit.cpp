#include "analysis/diagnose/selection/joint_refit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/hole_filling.hpp"
#include "analysis/diagnose/likelihood/mean_regression.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect.hpp"

namespace gyrolog::resolution {

constexpr int steps_most = 8;
constexpr int shortenings_most = 4;
// What a further step would gain.
constexpr double refit_settled_nats = 0.2;
// Of a parameter's size, over which the answer is taken for straight.
constexpr double straight = 1e-3;
// In one step a parameter falls to half at the most, or grows to three times: what was found beside others
// that took most of it is far too small.
constexpr double falls_most = 0.5;
constexpr double grows_most = 2.0;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

// One fitted parameter.
struct Parameter {
    std::size_t finding = 0;
    std::size_t entry = 0;
    std::string param;
};

double& value_at(std::vector<Finding>& findings, const Parameter& place) {
    return findings[place.finding].entries[place.entry].params.at(place.param);
}

bool can_be_simulated(const std::vector<Finding>& findings) {
    for (const Finding& finding : findings) {
        for (const EffectModel& entry : finding.entries) {
            if (effect_refusal(entry)) { return false; }
        }
    }
    return true;
}

SensorModel with_all(SensorModel model, const std::vector<Finding>& findings) {
    for (const Finding& finding : findings) { model = with_cause(std::move(model), finding); }
    return model;
}

class Refit {
public:
    Refit(const Prediction& without, std::shared_ptr<const Recording> recording,
          std::vector<Finding> findings, std::uint64_t seed)
        : without_(without), recording_(std::move(recording)), seed_(seed), best_(std::move(findings)) {
        for (std::size_t f = 0; f < best_.size(); ++f) {
            for (std::size_t e = 0; e < best_[f].entries.size(); ++e) {
                for (const auto& [name, sd] : best_[f].sd[e]) { places_.push_back({f, e, name}); }
            }
        }
    }

    JointRefit run() {
        Observation seen = observed(best_);
        double nats = log_likelihood_nats(seen);
        for (int step = 0; step < resolution::steps_most; ++step) {
            const NormalEquations equations = linearised(seen);
            const std::vector<double> by = equations.solution();
            if (!(equations.gain_nats(by) > resolution::refit_settled_nats)) { break; }
            bool better = false;
            for (int i = 0; i < resolution::shortenings_most && !better; ++i) {
                const std::vector<Finding> moved = moved_by(by, std::ldexp(1.0, -i));
                if (!can_be_simulated(moved)) { continue; }
                Observation there = observed(moved);
                const double nats_there = log_likelihood_nats(there);
                if (!(nats_there > nats)) { continue; }
                best_ = moved;
                seen = std::move(there);
                nats = nats_there;
                better = moved_ = true;
            }
            if (!better) { break; }
        }
        return {std::move(best_), nats, moved_};
    }

private:
    Observation observed(const std::vector<Finding>& findings) const {
        return {without_.with(with_all(without_.model(), findings)), recording_, seed_};
    }

    // Parameters keep their sign: of a size, or of what is found already.
    std::vector<Finding> moved_by(const std::vector<double>& by, double share) const {
        std::vector<Finding> moved = best_;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            double& value = value_at(moved, places_[i]);
            const double outwards = value < 0.0 ? -1.0 : 1.0;
            const double size = std::fabs(value);
            const double step = outwards * share * by[i];
            value +=
                outwards * std::clamp(step, -resolution::falls_most * size, resolution::grows_most * size);
        }
        return moved;
    }

    NormalEquations linearised(const Observation& seen) const {
        const Prediction& prediction = seen.prediction();
        std::array<std::vector<std::vector<float>>, 3> slopes;
        for (const Parameter& place : places_) {
            std::vector<Finding> moved = best_;
            double& value = value_at(moved, place);
            const double step = resolution::straight * (value != 0.0 ? std::fabs(value) : 1.0);
            value += step;
            const auto answer = noise_free_response(prediction, prediction.denoised_world(),
                                                    with_all(without_.model(), moved));
            const TransformPool::Lease transform = prediction.transform();
            for (const std::size_t axis : prediction.axes()) {
                const std::vector<float>& before = prediction.denoised_response_rad_s(axis);
                std::vector<double> slope(before.size());
                for (std::size_t slot = 0; slot < slope.size(); ++slot) {
                    slope[slot] =
                        (static_cast<double>(answer[axis][slot]) - static_cast<double>(before[slot])) / step;
                }
                slopes[axis].push_back(response_cosines(prediction, axis, std::move(slope), *transform));
            }
        }
        const std::size_t count = places_.size();
        NormalEquations sum{Matrix(count, count), std::vector<double>(count), {}, {}};
        for (const std::size_t axis : prediction.axes()) {
            const MeanResponses responses(prediction, axis, std::move(slopes[axis]));
            const MeanRegression regression(seen, axis, responses);
            sum.add(regression.equations(seen.axis(axis).density));
        }
        return sum;
    }

    const Prediction& without_;
    std::shared_ptr<const Recording> recording_;
    std::uint64_t seed_;
    std::vector<Finding> best_;
    std::vector<Parameter> places_;
    bool moved_ = false;
};

}  // namespace

JointRefit refit_jointly(const Prediction& without, const std::shared_ptr<const Recording>& recording,
                         std::vector<Finding> findings, std::uint64_t seed) {
    return Refit(without, recording, std::move(findings), seed).run();
}

}  // namespace gyrolog
