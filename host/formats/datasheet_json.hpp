// A data sheet as JSON, schema gyrolog-datasheet/1: what a maker prints, in the units that he prints it in.
// A unit is drawn from its tolerances (analysis/simulate/datasheet.hpp).
//
// The MPU-9250's, from PS-MPU-9250A-01 rev. 1.1, table 1 (range 500 dps):
//
//   {
//     "schema": "gyrolog-datasheet/1",
//     "sensor": "MPU-9250", "source": "PS-MPU-9250A-01 rev. 1.1, table 1",
//     "rate_hz": 1000,
//     "full_scale_dps": 500,
//     "sensitivity_lsb_per_dps": 65.5,
//     "noise_type": "one_sided",
//     "noise_density_dps_per_sqrt_hz": 0.01,
//     "zero_rate_output_dps": 5,
//     "zero_rate_output_over_temperature_dps": 30,
//     "scale_tolerance_percent": 3,
//     "scale_over_temperature_percent": 4,
//     "temperature_range_C": [-40, 85],
//     "cross_axis_percent": 2,
//     "nonlinearity_percent": 0.1,
//     "rate_tolerance_percent": 1
//   }
//
// Needed: rate_hz, full_scale_dps, noise_type, and the white noise as noise_density_dps_per_sqrt_hz or as
// total_rms_noise_dps with noise_bandwidth_hz, the equivalent noise bandwidth (of a Butterworth filter of
// order 2: 1.11 times its cut-off). Where both are given the density counts.
//
// noise_type is "one_sided" or "two_sided" and has no default: it says of which density noise_density and
// rate_random_walk are the root. Makers print one-sided densities (root mean square = density times sqrt of
// the bandwidth), sqrt(2) times the two-sided N of the model. A root mean square value over a bandwidth is
// the same either way, and so is bias_instability_deg_per_h, the lowest value of the Allan deviation: 0.664
// B.
//
// Optional besides those above: rate_random_walk_dps_sqrt_hz, bias_instability_deg_per_h,
// linear_acceleration_sensitivity_dps_per_g, temperature_noise_C, accelerometer_noise_g,
// reference_temperature_C (25). temperature_range_C is needed with a tolerance over temperature. All
// tolerances are half-widths ("+-5 dps" is 5). Without sensitivity_lsb_per_dps nothing is quantised. A key
// that is not named here is an error.
#pragma once

#include <optional>
#include <string>

#include "analysis/simulate/datasheet.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

inline constexpr const char* datasheet_schema = "gyrolog-datasheet/1";

// `problem`: the first thing that is wrong, with its key; the answer is then of no use.
Datasheet read_datasheet(const Json& document, std::optional<std::string>& problem);

}  // namespace gyrolog
