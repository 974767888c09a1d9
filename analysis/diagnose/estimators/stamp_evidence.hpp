// What the estimators of time stamps share. A simulation like a recording copies its stamps, so what the
// stamps say is known when the estimator is made, and chance is judged by the stamps' own distributions.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

// What is as good as certain is worth no more than this.
inline constexpr double certain_nats = 5000.0;

// The observation's stamps are those of its own sensor, not copied from another recording.
bool has_own_stamps(const Observation& observation);

// Uncertainty that the model states; where it states none, `otherwise`.
double stated_uncertainty(const std::map<std::string, double>& stated, const char* name, double otherwise);

// Sum over the model's entries of the effect that show in the stamps; `term` makes one of an entry's values.
double sum_in_stamps(const SensorModel& model, const EffectDefinition& effect,
                     double (*term)(const EffectValues&));

// A finding about the sensor as a whole: one entry for all axes of the prediction.
Finding whole_sensor_finding(const EffectDefinition& effect, const Prediction& prediction,
                             std::map<std::string, double> params, std::map<std::string, double> sd);

// Finds in the recording itself what its stamps say, and in simulations nothing; where neither the stamps nor
// the samples' timing can be judged, there is no estimator.
//   in_samples   asked of every observation: what the samples say about their own timing; may be null
MadeEstimator make_stamp_estimator(std::optional<Finding> in_stamps, std::string stamps_untestable,
                                   std::unique_ptr<Estimator> in_samples);

}  // namespace gyrolog
