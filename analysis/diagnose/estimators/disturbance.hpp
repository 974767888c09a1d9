// Disturbances are stretches in which something outside moved the sensor at rest. They are counted as the
// recording has them (analysis/recording/disturbances.hpp). The gain is that of a power of its own in every
// block of them, on every axis. A moving sensor has no such estimator: what its axes share is the motion.
//
// The effect's parameters are, in this order: number an hour, size in deg/s, decay in s.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_disturbance_estimator(const EffectDefinition& effect,
                                         std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
