// A sensor that moves against an orientation (ref_qw ... ref_qz) is judged in two passes, if it rests for
// long enough: sample by sample at its longest rest, where its noise shows; and in means of the whole
// recording, each against the angle turned meanwhile. An orientation's rates are far noisier than the sensor.
// Their error is read from the recording first (calibration/reference_error.hpp), and what is judged in means
// is how the sensor answers to the motion.
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

// Like diagnose(); `recording` moves_against_orientation() and its means have no diagnosis_refusal(). The
// model's noise is judged at rest alone.
std::optional<Diagnosis> diagnose_against_orientation(std::shared_ptr<const Recording> recording,
                                                      const SensorModel& model, const std::string& model_name,
                                                      const DiagnosisOptions& options);

}  // namespace gyrolog
