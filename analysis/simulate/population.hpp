// How the units of a kind of sensor differ, and one more of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/simulate/datasheet.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// Of one parameter, in its own unit.
struct UnitSpread {
    double median = 0.0;
    double sd = 0.0;  // between units
};

// What is not set is not known.
struct AxisPopulation {
    std::optional<UnitSpread> bias_rad_s;
    std::optional<UnitSpread> Q_rad;
    std::optional<UnitSpread> N_rad_per_sqrt_s;
    std::optional<UnitSpread> B_rad_per_s;
    std::optional<UnitSpread> K_rad_per_s_sqrt_s;
};

struct Population {
    std::optional<UnitSpread> rate_hz;  // of the sample clocks
    double full_scale_rad_s = no_range_rad_s;
    double lsb_rad_s = 0.0;  // 0: no quantisation
    std::array<AxisPopulation, 3> axes;
};

// Each parameter is drawn by itself: what they have in common, as a good N with a good B, is not kept.
//   bias:        Gaussian, median + sd z
//   Q, N, B, K:  log-normal, median exp(z sd / median): never negative, and of that median and, for small
//                spreads, that standard deviation
//   clock:       Gaussian; the model's rate is the median, and the unit's own stands as effect clock_rate
// The same seed draws the same unit; a parameter more leaves the others' draws alone. The model's sd (per
// axis), sd_abs bias_dps (of the widest axis) and rate_rel hold the spreads.
DrawnUnit draw_unit(const Population& population, std::uint64_t seed);

}  // namespace gyrolog
