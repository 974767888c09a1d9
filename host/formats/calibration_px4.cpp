#include "host/formats/calibration_px4.hpp"

#include <fmt/format.h>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "host/formats/calibration_head.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view px4_axes = "XYZ";
constexpr int type_int32 = 6;  // MAV_PARAM_TYPE
constexpr int type_real32 = 9;

std::string px4_parameter(const std::string& name, double value, int type = type_real32) {
    return fmt::format("1\t1\t{}\t{:.9g}\t{}\n", name, value, type);
}

// `sensor`: A or G.
std::string px4_thermal(char sensor, const TemperatureCalibration& fitted) {
    std::string text = px4_parameter(fmt::format("TC_{}_ENABLE", sensor), 1, type_int32);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        text += px4_parameter(fmt::format("TC_{}0_X0_{}", sensor, axis), 0.0);
        for (std::size_t k = 0; k < temperature_orders; ++k) {
            text += px4_parameter(fmt::format("TC_{}0_X{}_{}", sensor, k + 1, axis), fitted.axes[axis].c[k]);
        }
    }
    text += px4_parameter(fmt::format("TC_{}0_TREF", sensor), fitted.reference_C);
    text += px4_parameter(fmt::format("TC_{}0_TMIN", sensor), fitted.from_C);
    return text + px4_parameter(fmt::format("TC_{}0_TMAX", sensor), fitted.to_C);
}

}  // namespace

std::string px4_parameters(const Calibration& calibration) {
    std::string text = calibration_head(calibration, "#") + loss_without_matrix(calibration, "#");
    text +=
        "# corrected = (raw - thermal - OFF) * SCALE, m/s^2 and rad/s (Accelerometer.hpp and Gyroscope.hpp "
        "of\n"
        "# PX4-Autopilot, src/lib/sensor_calibration); thermal = X1 t + X2 t^2 + X3 t^3, t = T - TREF.\n"
        "# The board's own CAL_ACC0_ID, CAL_GYRO0_ID, TC_A0_ID and TC_G0_ID say which sensor that is: set "
        "them\n"
        "# to its device id, or the numbers are not used.\n"
        "#\n# Vehicle-Id Component-Id Name Value Type\n";
    if (const auto& fitted = calibration.accelerometer.calibration) {
        const Vector3 scales = axis_scales(fitted->M);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            text += px4_parameter(fmt::format("CAL_ACC0_{}OFF", px4_axes[axis]), fitted->bias_m_s2[axis]);
            text += px4_parameter(fmt::format("CAL_ACC0_{}SCALE", px4_axes[axis]), scales[axis]);
        }
    }
    if (const auto& fitted = calibration.gyro.calibration) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            text += px4_parameter(fmt::format("CAL_GYRO0_{}OFF", px4_axes[axis]), fitted->bias_rad_s[axis]);
        }
    }
    if (const auto& fitted = calibration.accelerometer_temperature.calibration; fitted && fitted->follows()) {
        text += px4_thermal('A', *fitted);
    }
    if (const auto& fitted = calibration.gyro_temperature.calibration; fitted && fitted->follows()) {
        text += px4_thermal('G', *fitted);
    }
    return text;
}

}  // namespace gyrolog
