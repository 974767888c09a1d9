// Gap domains are gap curves for the eye: in units that people use, with the band that simulations fill.
#pragma once

#include <vector>

#include "analysis/diagnose/calibration/gap_reference.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

// The curves of one observation with their reference.
struct JudgedCurves {
    const std::vector<GapCurve>& curves;
    const GapReference& reference;
};

// The function makes a domain of each curve. `after` is null where the model was not changed. The corrected
// model leaves another residual of the same recording: its band is drawn where it lies as seen from the
// recording. `band_probability`: of a simulation's point to lie in the band.
std::vector<GapDomain> gap_domains(const JudgedCurves& before, const JudgedCurves* after,
                                   double band_probability);

}  // namespace gyrolog
