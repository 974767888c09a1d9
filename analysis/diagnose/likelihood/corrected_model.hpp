// A corrected model is the model that was given with what was found in the recording.
#pragma once

#include "analysis/diagnose/report.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// The function adds the finding's entries to the model's effects.
SensorModel with_cause(SensorModel model, const Finding& finding);

// The function adds the entries, too. Slow noise that they add (EffectSignature::slow_coefficient) becomes as
// unknown as can be on their axes, so that its size is fitted again with whatever is found beside it: a
// course over the temperature and a random walk take up much of each other.
SensorModel with_open_cause(SensorModel model, const Finding& finding);

// The function puts the diagnosis' noise refits and causes into `model`. On the diagnosis' axes the bias
// becomes that of `centred`.
SensorModel corrected_model(SensorModel model, const Diagnosis& diagnosis, const SensorModel& centred);

// The function adds what the diagnosis modelled without a name, to the sensor that it is of.
SensorModel with_unnamed(SensorModel model, const Diagnosis& diagnosis);

}  // namespace gyrolog
