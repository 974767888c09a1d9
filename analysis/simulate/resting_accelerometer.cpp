#include "analysis/simulate/resting_accelerometer.hpp"

#include <string>
#include <string_view>

#include "analysis/recording/standard_gravity.hpp"

namespace gyrolog {
namespace {

// "sigma_g" is "sigma_dps" of a gyro, "c1_g_per_C" is "c1_dps_per_C". Empty: the name has no size in g.
std::string name_of_a_gyro(const std::string& name) {
    constexpr std::string_view in_g = "_g";
    const std::size_t at = name.find(in_g);
    const std::size_t end = at + in_g.size();
    if (at == std::string::npos || (end < name.size() && name[end] != '_')) { return {}; }
    return name.substr(0, at) + "_dps" + name.substr(end);
}

// Effects know deg/s: a size in g is given to them as what they make of it, m/s^2 in the place of rad/s.
EffectModel of_a_gyro(EffectModel effect) {
    std::map<std::string, double> params;
    for (const auto& [name, value] : effect.params) {
        if (const std::string known = name_of_a_gyro(name); !known.empty()) {
            params[known] = value * standard_gravity_m_s2 * deg_per_rad;
        } else {
            params[name] = value;
        }
    }
    effect.params = std::move(params);
    return effect;
}

}  // namespace

SensorModel resting_accelerometer(const SensorModel& model) {
    const AccelerometerModel& accelerometer = *model.accelerometer;
    SensorModel sensor;
    sensor.rate_hz = model.rate_hz;
    sensor.full_scale_rad_s = accelerometer.full_scale_m_s2;
    sensor.lsb_rad_s = accelerometer.lsb_m_s2;
    sensor.saturation_rad_s = accelerometer.saturation_m_s2;
    sensor.axes = accelerometer.axes;
    for (std::size_t axis = 0; axis < sensor.axes.size(); ++axis) {
        sensor.axes[axis].bias_rad_s += accelerometer.M[axis][2] * standard_gravity_m_s2;
    }
    for (const EffectModel& effect : accelerometer.effects) { sensor.effects.push_back(of_a_gyro(effect)); }
    return sensor;
}

}  // namespace gyrolog
