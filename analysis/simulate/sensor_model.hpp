// What the simulator models, in SI units: the contents of a gyrolog-model/1 file
// (host/formats/model_json.hpp).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/standard_gravity.hpp"

namespace gyrolog {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<Vector3, 3>;  // rows

inline constexpr Matrix3 identity_matrix = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
inline constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

// A range that nothing reaches: of a model that has none.
inline constexpr double no_range_rad_s = 1e9 * rad_per_deg;
inline constexpr double no_range_m_s2 = 1e9 * standard_gravity_m_s2;

struct AxisModel {
    NoiseCoefficients noise;  // two-sided convention
    double bias_rad_s = 0.0;
    std::map<std::string, double> sd_rel;  // this axis' own uncertainties, in place of the model's

    bool operator==(const AxisModel&) const = default;
};

struct TemperatureModel {
    double reference_C = 25.0;
    Vector3 bias_rad_s_per_C{};
    Vector3 scale_per_C{};  // relative change of the scale factor

    bool operator==(const TemperatureModel&) const = default;
};

// An effect that was added to the model: a name of the effect registry, with its parameters under the names
// and in the units that the effect itself defines.
struct EffectModel {
    std::string effect;
    std::vector<std::string> axes;
    std::map<std::string, double> params;
    std::string carried_json;  // keys of this entry that this build does not know; "" for none
    std::map<std::string, std::vector<double>> table{};  // columns by name, of one length; {} for none

    bool operator==(const EffectModel&) const = default;
};

// In m/s^2 where a gyro's model has rad/s: of the members of `axes` and of NoiseCoefficients, too.
struct AccelerometerModel {
    double full_scale_m_s2 = no_range_m_s2;
    double lsb_m_s2 = 0.0;  // 0: no quantisation
    double saturation_m_s2 = no_range_m_s2;
    std::array<AxisModel, 3> axes;
    Matrix3 M = identity_matrix;  // true specific force to measured one
    std::map<std::string, double> sd_rel;
    std::map<std::string, double> sd_abs;
    std::vector<EffectModel> effects;  // their params in g (sigma_g) in the place of deg/s (sigma_dps)

    bool operator==(const AccelerometerModel&) const = default;
};

struct SensorModel {
    double rate_hz = 100.0;
    double full_scale_rad_s = 0.0;
    double lsb_rad_s = 0.0;  // 0: no quantisation
    double saturation_rad_s = 0.0;
    std::array<AxisModel, 3> axes;
    Matrix3 M = identity_matrix;  // true rate to measured rate
    double latency_s = 0.0;
    double timestamp_jitter_s = 0.0;       // one sigma
    std::map<std::string, double> sd_rel;  // relative one-sigma uncertainties: N, B, K, timestamp_jitter, ...
    std::map<std::string, double> sd_abs;  // absolute ones: M (1), latency_s (s), rate_rel (1), ...
    double ref_noise_rad_s = 0.0;          // one sigma of a reference rate's samples
    double acc_noise_m_s2 = 0.0;           // one sigma of an accelerometer sample
    double temp_noise_C = 0.0;             // one sigma of a temperature sample
    std::optional<Matrix3> orientation;    // body to sensor
    std::optional<Vector3> misalignment;   // leak of each rate into the other two axes; a full matrix: M
    std::optional<TemperatureModel> temperature;
    std::vector<EffectModel> effects;
    std::optional<AccelerometerModel> accelerometer;
    std::string carried_json;  // keys that this build does not know, as JSON text; written back untouched; ""
                               // for none

    bool operator==(const SensorModel&) const = default;
};

// One sigma of the clock's rate, relative to it: as the model states it, otherwise a crystal's 50 ppm.
double clock_rate_sd_rel(const SensorModel& model);

// A typical MPU-9250 at 100 Hz and 500 dps: noise and range of its product specification (PS-MPU-9250A-01,
// table 1), bias instability and random walk as commonly measured.
SensorModel typical_mpu9250();

}  // namespace gyrolog
