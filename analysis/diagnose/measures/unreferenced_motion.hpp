// Without a reference rate, what turned is all noise to a diagnosis.
#pragma once

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// The function tells whether the rates of a recording without a reference stray from second to second far
// more than noise does: no drift is so fast, no vibration so slow.
bool seems_to_have_turned(const Observation& observation);

// Of the pairs of neighbouring seconds, the share whose mean rates differ on any axis by what no sensor at
// rest has: in the square by DecisionOptions::square_of_motion times what white noise alone has, and by twice
// what the largest plausible line has that folds to half a hertz, its peak to peak. White noise is the
// model's or that of the samples where the gyro rests (third differences, neighbour_scatter.hpp), whichever
// is more. A share, so that a few spikes, steps and bumps are no motion. 0 of a recording with a reference
// rate or orientation (columns ref_...).
double share_turned(const Recording& recording, const SensorModel& model);

}  // namespace gyrolog
