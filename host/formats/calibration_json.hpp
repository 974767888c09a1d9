// A calibration for programs: schema gyrolog-calibration/1.
//
//   recordings               names
//   gravity_m_s2             the size that was taken for gravity's
//   temperature_C            mean of the rests; absent without a temperature
//   rests                    [{recording (index), at_s, duration_s, force_g [3], rate_dps [3], temperature_C,
//                            residual_g (size of the calibrated force less gravity's)}]; forces and rates
//                            less the temperature's part
//   turns, moves             how many turns by a known angle, and moves of gravity, were used
//   accelerometer            absent where it is not determined. y = M a + b, a in orthogonal axes:
//     .M, .M_sd              3x3, rows of the sensor's axes; lower triangular; sd 0: no parameter
//     .bias_g, .bias_sd_g    [3]
//     .has_misalignment      false: M is diagonal
//     .names, .covariance    of the parameters, in 1 and m/s^2
//     .rms_g, .chi_squared, .degrees, .sd_factor (the residuals' over the means' scatter, in the sds)
//   gyro                     absent without a rest and a reference. y = M w + b + K f, w and f in the
//                            accelerometer's orthogonal axes, or w in the reference's:
//     .M, .M_sd              3x3; sd 0: not determined, the identity's. .has_scale [3]: M_ii is determined
//     .bias_dps, .bias_sd_dps
//     .g_sensitivity_dps_per_g, .g_sensitivity_sd_dps_per_g   3x3; absent where not determined
//     .names, .covariance    in rad/s, s/m and 1
//     .fits                  [{kind, count, rms, unit, sd_factor, redundancy}] by what the equations are from
//   temperature.gyro, temperature.accelerometer    absent where there is no ramp
//     .reference_C, .from_C, .to_C, .blocks, .unit ("dps" or "g")
//     .axes.x                order, c [3] in unit/degC, /degC^2, /degC^3, c_sd, covariance, residual_sd,
//                            correlation, F and F_needed [3] of the orders that were tried (0: not tried)
//   next_poses               [{up [3], words, parameter, sd_before, sd_after}], the best first
//   undetermined             [{what, add}]
//   warnings
#pragma once

#include "analysis/calibrate/calibration.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

Json calibration_json(const Calibration& calibration);

}  // namespace gyrolog
