#include "analysis/calibrate/calibrated_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/grid_step.hpp"
#include "analysis/simulate/recorded_converter.hpp"

namespace gyrolog {
namespace {

// Of a chi-squared variance.
double noise_sd_rel(double degrees) { return 1.0 / std::sqrt(2.0 * degrees); }

double root_mean_square(const Matrix3& sd) {
    double sum = 0.0;
    double count = 0.0;
    for (const Vector3& row : sd) {
        for (const double value : row) {
            if (value == 0.0) { continue; }
            sum += value * value;
            count += 1.0;
        }
    }
    return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

// What no turn told is known as well as a data sheet tells it.
Matrix3 with_open_ones(const GyroCalibration& gyro) {
    constexpr SensorTolerance tolerance;
    Matrix3 sd = gyro.M_sd;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t from = 0; from < 3; ++from) {
            if (gyro.M_sd[axis][from] > 0.0) { continue; }
            sd[axis][from] = axis == from ? tolerance.scale : tolerance.cross_axis;
        }
    }
    return sd;
}

void add_temperature(const TemperatureCalibration& temperature, const std::string& unit, double per_si,
                     std::vector<EffectModel>& effects) {
    constexpr std::array names{"temp_linear", "temp_quadratic", "temp_cubic"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const TemperaturePolynomial& polynomial = temperature.axes[axis];
        if (polynomial.order == 0) { continue; }
        EffectModel effect;
        effect.effect = names[polynomial.order - 1];
        effect.axes = {axis_names[axis]};
        effect.params["reference_C"] = temperature.reference_C;
        for (std::size_t k = 0; k < polynomial.order; ++k) {
            const std::string order = std::to_string(k + 1);
            std::string name = "c" + order;
            name.append("_").append(unit).append("_per_C").append(k == 0 ? "" : order);
            effect.params[name] = polynomial.c[k] * per_si;
        }
        effects.push_back(std::move(effect));
    }
}

void add_g_sensitivity(const GyroCalibration& gyro, std::vector<EffectModel>& effects) {
    if (!gyro.has_g_sensitivity) { return; }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EffectModel effect;
        effect.effect = "g_sensitivity";
        effect.axes = {axis_names[axis]};
        for (std::size_t from = 0; from < 3; ++from) {
            effect.params[std::string(axis_names[from]) + "_dps_per_g"] =
                gyro.K_s_per_m[axis][from] * deg_per_rad * standard_gravity_m_s2;
        }
        effects.push_back(std::move(effect));
    }
}

AccelerometerModel accelerometer_model(const Calibration& calibration, const Recording& recording) {
    AccelerometerModel model;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        model.axes[axis].noise.N_rad_per_sqrt_s = calibration.phases.scatter.force_m_s2_sqrt_s[axis];
        model.axes[axis].sd_rel["N"] = noise_sd_rel(calibration.phases.scatter.force_degrees);
        if (const Column* column = recording.find(std::string("a") + axis_names[axis])) {
            const RecordedConverter converter =
                recorded_converter(*column, grid_step(*column), axis == 0 ? 0.0 : model.full_scale_m_s2,
                                   SensorKind::accelerometer);
            model.lsb_m_s2 = converter.step_rad_s;
            model.full_scale_m_s2 = converter.full_scale_rad_s;
            model.saturation_m_s2 = converter.saturation_rad_s;
        }
    }
    if (calibration.accelerometer.calibration) {
        const AccelerometerCalibration& fitted = *calibration.accelerometer.calibration;
        model.M = fitted.M;
        model.sd_abs["M"] = root_mean_square(fitted.M_sd);
        for (std::size_t axis = 0; axis < 3; ++axis) { model.axes[axis].bias_rad_s = fitted.bias_m_s2[axis]; }
    }
    if (calibration.accelerometer_temperature.calibration) {
        add_temperature(*calibration.accelerometer_temperature.calibration, "g", 1.0 / standard_gravity_m_s2,
                        model.effects);
    }
    return model;
}

}  // namespace

SensorModel calibrated_model(const Calibration& calibration, const Recording& recording) {
    SensorModel model;
    model.rate_hz = recording.rate_hz * static_cast<double>(recording.samples_per_row);
    model.full_scale_rad_s = model.saturation_rad_s = no_range_rad_s;
    if (const auto converter = recorded_converter(recording)) {
        model.lsb_rad_s = converter->step_rad_s;
        model.full_scale_rad_s = converter->full_scale_rad_s;
        model.saturation_rad_s = converter->saturation_rad_s;
    }
    const MeanScatter& scatter = calibration.phases.scatter;
    for (std::size_t axis = 0; axis < 3 && scatter.rate_degrees > 0.0; ++axis) {
        model.axes[axis].noise.N_rad_per_sqrt_s = scatter.rate_rad_s_sqrt_s[axis];
        model.axes[axis].sd_rel["N"] = noise_sd_rel(scatter.rate_degrees);
    }
    if (calibration.gyro.calibration) {
        const GyroCalibration& gyro = *calibration.gyro.calibration;
        model.M = gyro.M;
        model.sd_abs["M"] = root_mean_square(with_open_ones(gyro));
        for (std::size_t axis = 0; axis < 3; ++axis) { model.axes[axis].bias_rad_s = gyro.bias_rad_s[axis]; }
        add_g_sensitivity(gyro, model.effects);
    }
    if (calibration.gyro_temperature.calibration) {
        const TemperatureCalibration& temperature = *calibration.gyro_temperature.calibration;
        add_temperature(temperature, "dps", deg_per_rad, model.effects);
    }
    if (calibration.has_accelerometer && scatter.force_degrees > 0.0) {
        model.accelerometer = accelerometer_model(calibration, recording);
    }
    return model;
}

}  // namespace gyrolog
