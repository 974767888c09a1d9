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
    // A spread of fewer is no spread: the interval of the robust standard deviation holds its chance from
    // four on (robust_spread.hpp).
    std::size_t units_least = 4;
    // Where a parameter is identified in fewer of the units, those are the larger ones: no fair sample.
    double identified_share_least = 0.5;
    double probability = 0.95;  // of the intervals
};

// The |robust z| beyond which a value stands out of so many units: of Gaussian values 1 in 2150 lies beyond
// it by chance, whatever the number of units. Of very many that is 3.5: B. Iglewicz, D. C. Hoaglin, "How to
// Detect and Handle Outliers", ASQC (1993), ch. 3. Of few the spread itself is uncertain, and beyond 3.5 lies
// 1 in 26 of 5: the bound is 36 there, 8 of 10, 5.2 of 20.
double outlier_bound(std::size_t units);

// Where a recording stands out.
struct OutlyingParameter {
    std::size_t recording = 0;  // its place among those that were given
    std::string axis;           // "" for rate_hz
    std::string name;
    double value = 0.0;  // in the unit of the population (population_json.hpp)
    double z = 0.0;
};

// What was measured of one unit; of several recordings the medians.
struct UnitValue {
    std::string unit;          // board or file
    double value = 0.0;        // in the unit of the population
    double uncertainty = 0.0;  // standard uncertainty
    bool stands_out = false;   // by the rule below; its recordings may do so one by one
};

// The units one by one.
struct UnitsOfParameter {
    std::string axis;  // "" for rate_hz
    std::string name;
    std::vector<UnitValue> units;
    std::optional<RobustSpread> spread;  // absent: of too few units
};

struct UnitPopulation {
    MeasuredPopulation measured;
    std::vector<OutlyingParameter> outliers;
    std::vector<UnitsOfParameter> parameters;  // without those that too few of the units have
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
// there is no spread, and none stands out. What is farther than outlier_bound() stands out.
UnitPopulation population_of(std::span<const FleetLine> recordings, const PopulationOptions& options = {});

}  // namespace gyrolog
