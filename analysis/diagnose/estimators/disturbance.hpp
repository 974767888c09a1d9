// Disturbances are stretches in which something outside moved the sensor at rest. They are counted as the
// recording has them (analysis/recording/disturbances.hpp). The gain is that of a power of its own in every
// block of them, on every axis. A moving sensor has no such estimator: what its axes share is the motion.
//
// The finding's parameters are the number an hour, the largest size in deg/s, and, in place of the decay, the
// mean length of a stretch in s. Its entry simulates no bumps.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

MadeEstimator make_disturbance_estimator(const EffectDefinition& effect,
                                         std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
