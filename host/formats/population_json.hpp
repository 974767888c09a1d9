// How the units of a kind of sensor differ, as JSON, schema gyrolog-population/1: a data sheet that was
// measured, from which a unit is drawn by its seed (analysis/simulate/population.hpp). `gyrolog table
// --population` writes one.
//
//   {
//     "schema": "gyrolog-population/1",
//     "units": 200,
//     "rate_hz": {"median": 99.98, "sd": 0.12},
//     "axes": {
//       "x": {"bias": {"median": 0.1, "sd": 0.8, "sd_lo": 0.7, "sd_hi": 0.9, "observed_sd": 0.8, "count":
//       200},
//             "N": {"median": 0.005, "sd": 2.0e-4}, "B": {"median": 0.002, "sd": 1.0e-4}},
//       "y": {...}, "z": {...}
//     }
//   }
//
// Units are those of gyrolog-model/1: bias and B dps, Q dps*s, N dps/sqrt(Hz), K dps*sqrt(Hz); N, B and K
// two-sided. Of a parameter `median` and `sd`, the standard deviation between units, are needed. Optional,
// for people: `count`, the interval `sd_lo`, `sd_hi`, and `observed_sd`, with the measurements' own
// uncertainty; `units`, `probability`, `recordings`, `notes`, `reported_by`. Of axes at least one is needed;
// what one lacks is not simulated, and said. Without rate_hz, full_scale_dps and lsb_dps a recording tells
// them (--like), or
// --rate. A key that is not named here is an error.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/numerics/robust_spread.hpp"
#include "analysis/simulate/population.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

inline constexpr const char* population_schema = "gyrolog-population/1";

// `problem`: the first thing that is wrong, with its key; the answer is then of no use.
Population read_population(const Json& document, std::optional<std::string>& problem);

// What was measured, in the file's units.
struct MeasuredParameter {
    std::string axis;  // "x", "y", "z"; "" for rate_hz
    std::string name;  // "bias", "Q", "N", "B", "K", "rate_hz"
    RobustSpread spread;
};
struct MeasuredPopulation {
    std::size_t units = 0;
    double probability = 0.95;  // of the intervals
    std::vector<MeasuredParameter> parameters;
    std::vector<std::string> notes;
};

std::string format_population(const MeasuredPopulation& population);

}  // namespace gyrolog
