// A sensor's data sheet, and a unit of that kind.
//
// A data sheet gives limits. Nothing else being known, a unit's value is drawn from the rectangle between
// them (JCGM 100:2008, 4.3.7), whose standard uncertainty is the half-width over sqrt(3).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// SI units; ratios are plain numbers. What is not set the sheet does not give.
struct Datasheet {
    std::string sensor;  // for notes
    double rate_hz = 0.0;
    double full_scale_rad_s = 0.0;
    double lsb_rad_s = 0.0;                    // 0: no quantisation
    double N_rad_per_sqrt_s = 0.0;             // two-sided
    std::optional<double> B_rad_per_s;         // two-sided
    std::optional<double> K_rad_per_s_sqrt_s;  // two-sided

    // Half-widths of the tolerances.
    std::optional<double> zero_rate_rad_s;
    std::optional<double> zero_rate_over_temperature_rad_s;
    std::optional<double> scale;
    std::optional<double> scale_over_temperature;
    std::optional<double> cross_axis;
    std::optional<double> nonlinearity;  // of full scale
    std::optional<double> g_sensitivity_s_per_m;
    std::optional<double> rate;  // relative, of the sample clock

    double reference_C = 25.0;
    double temperature_from_C = 0.0;  // where the tolerances over temperature hold
    double temperature_to_C = 0.0;
    double temperature_noise_C = 0.0;  // one sigma
    double accelerometer_noise_m_s2 = 0.0;
};

struct DrawnUnit {
    SensorModel model;
    std::vector<std::string> notes;  // what the data sheet does not give, so that it is not simulated
};

// The same seed draws the same unit; a parameter more in the sheet leaves the others' draws alone.
//
// Bias: within zero_rate. Scale factor and cross-axis gains: the diagonal of M within 1 +- scale, each other
// element within +- cross_axis. Over temperature: a straight line whose value at the end of the range that is
// farther from the reference lies within the tolerance. Nonlinearity: a quadratic and a cubic part, each
// within half of it, as effects; sensitivity to specific force and the clock's error as effects, too.
//
// The model's sd_abs holds the standard uncertainty of what was drawn: M (of the wider of its two
// tolerances), rate_rel, and in the units of their names bias_dps, bias_dps_per_C and scale_percent_per_C.
DrawnUnit draw_unit(const Datasheet& sheet, std::uint64_t seed);

}  // namespace gyrolog
