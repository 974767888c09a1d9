#include "analysis/simulate/accelerometer_as_gyro.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "analysis/noise/sensor_columns.hpp"
#include "analysis/simulate/accelerometer_effect.hpp"
#include "analysis/simulate/resting_accelerometer.hpp"

namespace gyrolog {
namespace {

bool is_scaled(const Column& column) {
    return is_of(SensorKind::accelerometer, column) && column.unit == "m/s^2";
}

bool is_exposure(const Column& column) { return column.name.starts_with("ref_a") && column.unit == "m/s^2"; }

void scale(NoiseCoefficients& noise, double factor) {
    noise.Q_rad *= factor;
    noise.N_rad_per_sqrt_s *= factor;
    noise.B_rad_per_s *= factor;
    noise.K_rad_per_s_sqrt_s *= factor;
    noise.R_rad_per_s2 *= factor;
}

using Uncertainties = std::map<std::string, double>;

void take(const char* key, const Uncertainties& from, Uncertainties& to) {
    if (const auto sd = from.find(key); sd != from.end()) { to.insert(*sd); }
}

// One that nothing reaches stays so.
double scaled_range(double range, double none, double factor, double none_after) {
    return range < none ? range * factor : none_after;
}

}  // namespace

std::optional<Recording> accelerometer_as_gyro(const Recording& recording) {
    if (std::ranges::none_of(recording.columns, is_scaled)) { return std::nullopt; }
    Recording sensor = rows_with_accelerometer(recording).value_or(recording);
    if (const std::size_t lost = recording.rows() - sensor.rows(); lost > 0) {
        sensor.warnings.push_back("accelerometer: " + std::to_string(lost) +
                                  " of the rows have no value of it and are missing to it");
    }
    std::erase_if(sensor.columns, [](const Column& column) {
        return !is_scaled(column) && !is_exposure(column) && column.name != "temp";
    });
    std::stable_partition(sensor.columns.begin(), sensor.columns.end(), is_scaled);
    for (Column& column : sensor.columns) {
        if (is_exposure(column)) {
            column.name.erase(column.name.find('a'), 1);
        } else if (is_scaled(column)) {
            column.name[0] = 'g';
        } else {
            continue;
        }
        column.unit = "rad/s";
        column.scale *= accelerometer_rad_s_per_m_s2;
        column.source_unit.clear();
    }
    return sensor;
}

Exposure exposure_of(const Recording& as_gyro) {
    const bool is_known = std::ranges::any_of(
        axis_names, [&](const char* axis) { return as_gyro.find(std::string("ref_") + axis) != nullptr; });
    return is_known ? Exposure::known : Exposure::upright;
}

Recording accelerometer_of_gyro(Recording as_gyro) {
    for (Column& column : as_gyro.columns) {
        if (!is_of(SensorKind::gyro, column)) { continue; }
        column.name[0] = 'a';
        column.unit = "m/s^2";
        column.scale /= accelerometer_rad_s_per_m_s2;
    }
    return as_gyro;
}

SensorModel accelerometer_as_gyro(const SensorModel& model, Exposure exposure) {
    constexpr double factor = accelerometer_rad_s_per_m_s2;
    const AccelerometerModel& accelerometer = *model.accelerometer;
    SensorModel sensor =
        exposure == Exposure::known ? exposed_accelerometer(model) : resting_accelerometer(model);
    for (AxisModel& axis : sensor.axes) {
        scale(axis.noise, factor);
        axis.bias_rad_s *= factor;
    }
    sensor.full_scale_rad_s =
        scaled_range(accelerometer.full_scale_m_s2, no_range_m_s2, factor, no_range_rad_s);
    sensor.saturation_rad_s =
        scaled_range(accelerometer.saturation_m_s2, no_range_m_s2, factor, no_range_rad_s);
    sensor.lsb_rad_s = accelerometer.lsb_m_s2 * factor;
    sensor.effects.clear();
    for (const EffectModel& effect : accelerometer.effects) {
        sensor.effects.push_back(as_gyro_effect(effect, factor));
    }
    sensor.sd_rel = accelerometer.sd_rel;
    take("timestamp_jitter", model.sd_rel, sensor.sd_rel);
    take("rate_rel", model.sd_abs, sensor.sd_abs);
    if (exposure == Exposure::known) { take("M", accelerometer.sd_abs, sensor.sd_abs); }
    sensor.timestamp_jitter_s = model.timestamp_jitter_s;
    sensor.temp_noise_C = model.temp_noise_C;
    return sensor;
}

SensorModel with_accelerometer_of(SensorModel model, const SensorModel& as_gyro, Exposure exposure) {
    constexpr double factor = 1.0 / accelerometer_rad_s_per_m_s2;
    const AccelerometerModel before = model.accelerometer.value_or(AccelerometerModel{});
    AccelerometerModel& accelerometer = model.accelerometer.emplace(before);
    for (std::size_t axis = 0; axis < accelerometer.axes.size(); ++axis) {
        accelerometer.axes[axis].noise = as_gyro.axes[axis].noise;
        scale(accelerometer.axes[axis].noise, factor);
        accelerometer.axes[axis].sd_rel = as_gyro.axes[axis].sd_rel;
        if (exposure == Exposure::known) {
            accelerometer.axes[axis].bias_rad_s = as_gyro.axes[axis].bias_rad_s * factor;
        }
    }
    accelerometer.full_scale_m_s2 =
        scaled_range(as_gyro.full_scale_rad_s, no_range_rad_s, factor, no_range_m_s2);
    accelerometer.saturation_m_s2 =
        scaled_range(as_gyro.saturation_rad_s, no_range_rad_s, factor, no_range_m_s2);
    accelerometer.lsb_m_s2 = as_gyro.lsb_rad_s * factor;
    accelerometer.sd_rel = as_gyro.sd_rel;
    accelerometer.sd_rel.erase("timestamp_jitter");
    accelerometer.effects.clear();
    for (const EffectModel& effect : as_gyro.effects) {
        accelerometer.effects.push_back(as_accelerometer_effect(effect, accelerometer_rad_s_per_m_s2));
    }
    return model;
}

}  // namespace gyrolog
