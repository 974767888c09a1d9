// Stamp evidence is what the estimators of time stamps share. A simulation like a recording copies its
// stamps. So what the stamps say is known when the estimator is made, and chance is judged by the stamps' own
// distributions.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

namespace resolution {

// What is as good as certain is worth no more than this.
inline constexpr double certain_nats = 5000.0;

}  // namespace resolution

// Whether the observation's stamps are those of its own sensor, not copied from another recording.
bool has_own_stamps(const Observation& observation);

// The function returns the uncertainty that the model states, or `otherwise` where it states none.
double stated_uncertainty(const std::map<std::string, double>& stated, const char* name, double otherwise);

// The function sums over the model's entries of the effect that show in the stamps. `term` makes one of an
// entry's values.
double sum_in_stamps(const SensorModel& model, const EffectDefinition& effect,
                     double (*term)(const EffectValues&));

// The finding is about the sensor as a whole: one entry for all axes of the prediction.
Finding whole_sensor_finding(const EffectDefinition& effect, const Prediction& prediction,
                             std::map<std::string, double> params, std::map<std::string, double> sd);

// The estimator finds in the recording itself what its stamps say, and in simulations nothing. There is none
// where neither the stamps nor the samples' timing can be judged. `in_samples` is asked of every observation
// what the samples say about their own timing; it may be null.
MadeEstimator make_stamp_estimator(std::optional<Finding> in_stamps, std::string stamps_untestable,
                                   std::unique_ptr<Estimator> in_samples);

}  // namespace gyrolog
