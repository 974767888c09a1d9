// Gap curves for the eye: in units that people use, with the band that simulations fill.
#pragma once

#include <vector>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// Curves of one observation with their reference.
struct MeasuredGap {
    const std::vector<GapCurve>& curves;
    const GapReference& reference;
};

// `after`: null where the model was not changed. The corrected model leaves another residual of the same
// recording: its band is drawn where it lies as seen from the recording.
std::vector<GapDomain> gap_domains(const MeasuredGap& before, const MeasuredGap* after,
                                   double band_probability);

}  // namespace gyrolog
