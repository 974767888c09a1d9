#include "host/formats/calibration_ardupilot.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "host/formats/calibration_head.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view axes_upper = "XYZ";
constexpr double reference_C = 35.0;     // TEMP_REFERENCE
constexpr double per_coefficient = 1e6;  // SCALE_FACTOR
using Coefficients = std::array<double, temperature_orders>;

std::string parameter(const std::string& name, double value) {
    return fmt::format("{},{:.9g}\n", name, value);
}

// About ArduPilot's reference; the constant is left out.
Coefficients about_reference(const TemperatureCalibration& fitted, std::size_t axis) {
    const Coefficients& c = fitted.axes[axis].c;
    const double d = reference_C - fitted.reference_C;
    return {c[0] + (2.0 * c[1] + 3.0 * c[2] * d) * d, c[1] + 3.0 * c[2] * d, c[2]};
}

// `sensor`: ACC or GYR.
std::string thermal(const char* sensor, const TemperatureCalibration& fitted) {
    std::string text;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Coefficients c = about_reference(fitted, axis);
        for (std::size_t k = 0; k < c.size(); ++k) {
            text += parameter(fmt::format("INS_TCAL1_{}{}_{}", sensor, k + 1, axes_upper[axis]),
                              c[k] * per_coefficient);
        }
    }
    return text;
}

// Of the temperature at which the bias is that of the offset.
std::string calibrated_at(const char* name, const Calibration& calibration,
                          const TemperatureResult& thermal) {
    if (thermal.calibration) { return parameter(name, thermal.calibration->reference_C); }
    return calibration.temperature_C ? parameter(name, *calibration.temperature_C) : "";
}

std::string thermal_text(const Calibration& calibration) {
    const auto& accelerometer = calibration.accelerometer_temperature.calibration;
    const auto& gyro = calibration.gyro_temperature.calibration;
    const bool accelerometer_follows = accelerometer && accelerometer->follows();
    const bool gyro_follows = gyro && gyro->follows();
    if (!accelerometer_follows && !gyro_follows) { return {}; }
    std::string text = "INS_TCAL1_ENABLE,1\n";
    double from_C = accelerometer_follows ? accelerometer->from_C : gyro->from_C;
    double to_C = accelerometer_follows ? accelerometer->to_C : gyro->to_C;
    if (accelerometer_follows && gyro_follows) {
        from_C = std::max(from_C, gyro->from_C);
        to_C = std::min(to_C, gyro->to_C);
    }
    text += parameter("INS_TCAL1_TMIN", from_C) + parameter("INS_TCAL1_TMAX", to_C);
    if (accelerometer_follows) { text += thermal("ACC", *accelerometer); }
    if (gyro_follows) { text += thermal("GYR", *gyro); }
    return text;
}

}  // namespace

std::string ardupilot_parameters(const Calibration& calibration) {
    std::string text = calibration_head(calibration, "#") + loss_without_matrix(calibration, "#");
    text +=
        "# corrected = (raw - p(T) + p(CALTEMP) - OFFS) * SCAL, m/s^2 and rad/s, p(T) = 1e-6 (c1 s + c2 s^2 "
        "+ c3\n"
        "# s^3), s = T - 35 degC (ArduPilot, AP_InertialSensor_Backend.cpp and "
        "AP_InertialSensor_tempcal.cpp).\n"
        "# The gyro's offsets are learnt anew at each start unless INS_GYR_CAL is 0.\n";
    if (const auto& fitted = calibration.accelerometer.calibration) {
        const Vector3 scales = axis_scales(fitted->M);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            text += parameter(fmt::format("INS_ACCOFFS_{}", axes_upper[axis]), fitted->bias_m_s2[axis]);
            text += parameter(fmt::format("INS_ACCSCAL_{}", axes_upper[axis]), scales[axis]);
        }
        text += calibrated_at("INS_ACC1_CALTEMP", calibration, calibration.accelerometer_temperature);
    }
    if (const auto& fitted = calibration.gyro.calibration) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            text += parameter(fmt::format("INS_GYROFFS_{}", axes_upper[axis]), fitted->bias_rad_s[axis]);
        }
        text += calibrated_at("INS_GYR1_CALTEMP", calibration, calibration.gyro_temperature);
    }
    return text + thermal_text(calibration);
}

}  // namespace gyrolog
