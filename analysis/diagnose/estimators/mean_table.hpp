// The mean-table estimators find a course of the mean without a formula: over the temperature, or over the
// true rate about the axis.
#pragma once

#include "analysis/diagnose/estimators/estimator.hpp"

namespace gyrolog {

// The course is straight between knots that divide the range which the recording has into equal parts; how
// many is told by the evidence in Schwarz's approximation (Ann. Stat. 6 (1978) 461). Each axis has its own.
MadeEstimator make_temperature_table_estimator(const EffectDefinition& effect,
                                               std::shared_ptr<const Prediction> prediction);
MadeEstimator make_rate_table_estimator(const EffectDefinition& effect,
                                        std::shared_ptr<const Prediction> prediction);

}  // namespace gyrolog
