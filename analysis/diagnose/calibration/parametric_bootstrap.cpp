#include "analysis/diagnose/calibration/parametric_bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "analysis/diagnose/calibration/replicates.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

// Sixteen know a standard deviation to 18 %. Of long recordings fewer, for their time; of a new world, where
// the sensor moves, the sooner.
constexpr std::size_t simulations_most = 16;
constexpr double samples_of_all_at_rest = 6e6;
constexpr std::size_t simulations_least_at_rest = 6;
constexpr double samples_of_all_in_motion = 1.5e6;
constexpr std::size_t simulations_least_in_motion = 4;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

double difference(const std::string& param, double a, double b) {
    return param.ends_with("phase_rad") ? std::remainder(a - b, 2.0 * std::numbers::pi) : a - b;
}

// Of the entries that act on the axes, the mean.
std::optional<double> value_for(const Finding& again, const EffectModel& entry, const std::string& param) {
    double sum = 0.0;
    double count = 0.0;
    const double put_in = entry.params.at(param);
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        if (!acts_on(entry, axis)) { continue; }
        for (const EffectModel& other : again.entries) {
            const auto value = other.params.find(param);
            if (!acts_on(other, axis) || value == other.params.end()) { continue; }
            sum += difference(param, value->second, put_in);
            count += 1.0;
        }
    }
    return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

std::size_t simulations_of(const Prediction& prediction) {
    const bool moves = prediction.moves();
    const double all = moves ? resolution::samples_of_all_in_motion : resolution::samples_of_all_at_rest;
    const auto affordable = static_cast<std::size_t>(all / static_cast<double>(prediction.length()));
    return std::clamp(affordable,
                      moves ? resolution::simulations_least_in_motion : resolution::simulations_least_at_rest,
                      resolution::simulations_most);
}

double root_mean_square(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) { sum += value * value; }
    return std::sqrt(sum / static_cast<double>(values.size()));
}

class ParametricBootstrap {
public:
    ParametricBootstrap(const std::shared_ptr<const Prediction>& without, const SensorModel& corrected,
                        const std::vector<Finding>& causes, const BootstrapOptions& options)
        : without_(without),
          corrected_(corrected),
          causes_(causes),
          options_(options),
          simulations_(simulations_of(*without)),
          new_worlds_(can_be_measured_anew(*without)) {
        for (std::size_t i = 0; i < causes_.size(); ++i) {
            SensorModel model = without_->model();
            for (std::size_t other = 0; other < causes_.size(); ++other) {
                if (other != i) { model = with_cause(std::move(model), causes_[other]); }
            }
            others_.push_back(std::move(model));
        }
        for (std::size_t i = 0; i < causes_.size() && !new_worlds_; ++i) {
            estimators_.push_back(sought(without_->with(others_[i]), i));
        }
    }

    // By simulation and cause what was found again; empty when ended early.
    std::vector<std::vector<std::optional<Finding>>> found_again() const {
        std::vector<std::vector<std::optional<Finding>>> again(simulations_);
        const ReplicateOptions draws{simulations_, options_.seed, RandomPurpose::bootstrap_simulations,
                                     options_.threads, options_.on_progress};
        const bool done = for_each_replicate(
            draws, [&](std::size_t i, std::uint64_t seed) { again[i] = in_simulation(seed); });
        if (!done) { again.clear(); }
        return again;
    }

private:
    struct Sought {
        std::shared_ptr<const Prediction> prediction;
        std::shared_ptr<const Estimator> estimator;  // null: not to be seen there
    };

    Sought sought(std::shared_ptr<const Prediction> prediction, std::size_t cause) const {
        MadeEstimator made = make_estimator(*find_effect(causes_[cause].effect), prediction);
        return {std::move(prediction), std::move(made.estimator)};
    }

    std::vector<std::optional<Finding>> in_simulation(std::uint64_t seed) const {
        Recording simulated = replicate_recording(*without_, corrected_, seed);
        if (new_worlds_) { simulated = measured_anew(std::move(simulated), corrected_, seed); }
        const auto recording = std::make_shared<const Recording>(std::move(simulated));
        const auto world = new_worlds_ ? std::make_shared<const RecordedWorld>(recording) : nullptr;
        const auto noise =
            new_worlds_ ? Observation::ReferenceNoise::measured_anew : Observation::ReferenceNoise::drawn;
        std::vector<std::optional<Finding>> findings;
        for (std::size_t i = 0; i < causes_.size(); ++i) {
            const Sought there =
                new_worlds_ ? sought(without_->in_world(world, others_[i]), i) : estimators_[i];
            findings.push_back(
                there.estimator ? there.estimator->find(Observation(there.prediction, recording, seed, noise))
                                : std::nullopt);
        }
        return findings;
    }

    const std::shared_ptr<const Prediction>& without_;
    const SensorModel& corrected_;
    const std::vector<Finding>& causes_;
    const BootstrapOptions& options_;
    const std::size_t simulations_;
    const bool new_worlds_;            // each simulation's motion is measured anew
    std::vector<SensorModel> others_;  // by cause: the model with all but it
    std::vector<Sought> estimators_;   // by cause
};

}  // namespace

std::optional<std::vector<Finding>> with_bootstrap_sd(const std::shared_ptr<const Prediction>& without,
                                                      const SensorModel& corrected,
                                                      std::vector<Finding> causes,
                                                      const BootstrapOptions& options) {
    const auto again = ParametricBootstrap(without, corrected, causes, options).found_again();
    if (again.empty()) { return std::nullopt; }
    for (std::size_t i = 0; i < causes.size(); ++i) {
        Finding& cause = causes[i];
        for (std::size_t entry = 0; entry < cause.entries.size(); ++entry) {
            for (auto& [param, sd] : cause.sd[entry]) {
                std::vector<double> off;
                for (const std::vector<std::optional<Finding>>& findings : again) {
                    if (!findings[i]) { continue; }
                    if (const auto value = value_for(*findings[i], cause.entries[entry], param)) {
                        off.push_back(*value);
                    }
                }
                if (!off.empty()) { sd = std::max(sd, root_mean_square(off)); }
            }
        }
    }
    return causes;
}

}  // namespace gyrolog
