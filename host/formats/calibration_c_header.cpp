#include "host/formats/calibration_c_header.hpp"

#include <fmt/format.h>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "host/formats/calibration_head.hpp"

namespace gyrolog {
namespace {

std::string vector_text(const std::string& name, const std::string& unit, const Vector3& values) {
    return fmt::format("static const double {}[3] = {{{:.9g}, {:.9g}, {:.9g}}}; /* {} */\n", name, values[0],
                       values[1], values[2], unit);
}

std::string matrix_text(const std::string& name, const std::string& unit, const Matrix3& matrix) {
    std::string text = fmt::format("static const double {}[3][3] = {{ /* {} */\n", name, unit);
    for (const Vector3& row : matrix) {
        text += fmt::format("    {{{:.9g}, {:.9g}, {:.9g}}},\n", row[0], row[1], row[2]);
    }
    return text + "};\n";
}

// `prefix`: "gyrolog_gyro" or "gyrolog_acc"; rows are axes.
std::string thermal_arrays(const std::string& prefix, const std::string& unit,
                           const TemperatureResult& fitted) {
    const TemperatureCalibration none;
    const TemperatureCalibration& thermal = fitted.calibration ? *fitted.calibration : none;
    Matrix3 c{};
    for (std::size_t axis = 0; axis < 3; ++axis) { c[axis] = thermal.axes[axis].c; }
    return matrix_text(prefix + "_temperature", unit + " per degC, degC^2, degC^3", c) +
           vector_text(prefix + "_temperature_C", "reference, least, most: degC",
                       {thermal.reference_C, thermal.from_C, thermal.to_C});
}

constexpr std::string_view functions = R"(
static inline double gyrolog_thermal(const double c[3], const double range_C[3], double temperature_C) {
    double t = temperature_C;
    if (t < range_C[1]) { t = range_C[1]; }
    if (t > range_C[2]) { t = range_C[2]; }
    t -= range_C[0];
    return (c[0] + (c[1] + c[2] * t) * t) * t;
}

/* force = correction * (raw - bias - thermal), m/s^2 */
static inline void gyrolog_calibrate_acc(const double raw[3], double temperature_C, double force[3]) {
    double y[3];
    for (int i = 0; i < 3; ++i) {
        y[i] = raw[i] - gyrolog_acc_bias[i] -
               gyrolog_thermal(gyrolog_acc_temperature[i], gyrolog_acc_temperature_C, temperature_C);
    }
    for (int i = 0; i < 3; ++i) {
        force[i] = gyrolog_acc_correction[i][0] * y[0] + gyrolog_acc_correction[i][1] * y[1] +
                   gyrolog_acc_correction[i][2] * y[2];
    }
}

/* rate = correction * (raw - bias - thermal - g_sensitivity * force), rad/s; force as calibrated */
static inline void gyrolog_calibrate_gyro(const double raw[3], const double force[3], double temperature_C,
                                          double rate[3]) {
    double y[3];
    for (int i = 0; i < 3; ++i) {
        y[i] = raw[i] - gyrolog_gyro_bias[i] -
               gyrolog_thermal(gyrolog_gyro_temperature[i], gyrolog_gyro_temperature_C, temperature_C) -
               gyrolog_gyro_g_sensitivity[i][0] * force[0] - gyrolog_gyro_g_sensitivity[i][1] * force[1] -
               gyrolog_gyro_g_sensitivity[i][2] * force[2];
    }
    for (int i = 0; i < 3; ++i) {
        rate[i] = gyrolog_gyro_correction[i][0] * y[0] + gyrolog_gyro_correction[i][1] * y[1] +
                  gyrolog_gyro_correction[i][2] * y[2];
    }
}
)";

}  // namespace

std::string calibration_c_header(const Calibration& calibration) {
    const AccelerometerCalibration accelerometer =
        calibration.accelerometer.calibration.value_or(AccelerometerCalibration{});
    const GyroCalibration gyro = calibration.gyro.calibration.value_or(GyroCalibration{});
    std::string text = calibration_head(calibration, "//");
    text += "#ifndef GYROLOG_CALIBRATION_H\n#define GYROLOG_CALIBRATION_H\n\n";
    text += matrix_text("gyrolog_acc_correction", "1", inverse(accelerometer.M).value_or(identity_matrix));
    text += vector_text("gyrolog_acc_bias", "m/s^2", accelerometer.bias_m_s2);
    text += thermal_arrays("gyrolog_acc", "m/s^2", calibration.accelerometer_temperature);
    text += matrix_text("gyrolog_gyro_correction", "1", inverse(gyro.M).value_or(identity_matrix));
    text += vector_text("gyrolog_gyro_bias", "rad/s", gyro.bias_rad_s);
    text += matrix_text("gyrolog_gyro_g_sensitivity", "rad/s per m/s^2", gyro.K_s_per_m);
    text += thermal_arrays("gyrolog_gyro", "rad/s", calibration.gyro_temperature);
    text += functions;
    return text + "\n#endif\n";
}

}  // namespace gyrolog
