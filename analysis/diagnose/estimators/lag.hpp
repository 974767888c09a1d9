// The lag estimators read the sensor's timing from its motion, where stamps hide it: a lag that grows
// steadily (a clock off its rate) or in steps (lost samples), found by likelihood/lag_course.hpp. The gain is
// the likelihood of the whole observation with the effect in the model less that without, noise and the
// model's uncertain answers refitted.
#pragma once

#include <memory>

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

// The functions return null for a recording without motion.
std::unique_ptr<Estimator> make_lag_slope_estimator(const EffectDefinition& effect,
                                                    std::shared_ptr<const Prediction> prediction);
std::unique_ptr<Estimator> make_lag_step_estimator(const EffectDefinition& effect,
                                                   std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
