// A sensor that moves against a reference of which no model says how good it is.
//
// Rates whose noise is known well from a rest (reference_noise.hpp) are a reference that is known, but for
// those of other gyros of an array (array_reference.hpp), which drift and hum as the judged one does. Against
// any other the sensor is judged in two passes, if it rests for long enough: at its longest rest, where its
// noise shows; and over the whole recording, in rows, where how it answers to the motion does. The error of
// the reference is read from the rows first (calibration/reference_error.hpp). Against an orientation (ref_qw
// ... ref_qz), whose rates are far noisier than the sensor, a row is a mean, against the angle turned
// meanwhile.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "analysis/diagnose/diagnosis.hpp"

namespace gyrolog {

// The recording has an orientation for its reference, and no rates.
bool moves_against_orientation(const Recording& recording);

// The means that the second pass judges: those of the samples, and ref_x ref_y ref_z, of the angle turned, in
// place of the orientation.
Recording means_against_orientation(const Recording& recording);

// Like diagnose(), and the same where there is no such reference: no reference at all, rates whose noise the
// model states, rates without noise, or an orientation of which there are too few means.
std::optional<Diagnosis> diagnose_in_motion(const std::shared_ptr<const Recording>& recording,
                                            const SensorModel& model, const std::string& model_name,
                                            const DiagnosisOptions& options);

}  // namespace gyrolog
