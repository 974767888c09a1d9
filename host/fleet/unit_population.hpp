// The spread between the units that lines are about, and the units that stand out of it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/fleet/fleet_line.hpp"
#include "host/formats/population_json.hpp"

namespace gyrolog {

struct PopulationOptions {
    // Of |robust z|: B. Iglewicz, D. C. Hoaglin, "How to Detect and Handle Outliers", ASQC (1993), ch. 3. One
    // in 2150 of Gaussian values lies beyond it by chance.
    double outlier_z = 3.5;
    // A spread of fewer is no spread: the interval of the robust standard deviation holds its chance from
    // four on (robust_spread.hpp).
    std::size_t units_least = 4;
    // Where a parameter is identified in fewer of the units, those are the larger ones: no fair sample.
    double identified_share_least = 0.5;
    double probability = 0.95;  // of the intervals
};

// Where a recording stands out.
struct OutlyingParameter {
    std::size_t recording = 0;  // its place among those that were given
    std::string axis;           // "" for rate_hz
    std::string name;
    double z = 0.0;
};

struct UnitPopulation {
    MeasuredPopulation measured;
    std::vector<OutlyingParameter> outliers;
};

// Of each parameter (bias, Q, N, B, K by axis x, y, z of the gyro, and rate_hz) with enough units: a unit is
// a board by its serial number, or where there is none a recording. Of several recordings of a board the
// median counts. Rates in rad/s are taken in dps; counts without a scale are left out and noted, as is what
// too few units have.
//
//   z = (value - median) / s,  s^2 = the larger of observed_sd^2 and sd^2 + u^2, u: the value's own
//   uncertainty
//
// so that a short recording does not stand out by its noise. Where more than half of the values are equal
// there is no spread, and none stands out.
UnitPopulation population_of(std::span<const FleetLine> recordings, const PopulationOptions& options = {});

}  // namespace gyrolog
