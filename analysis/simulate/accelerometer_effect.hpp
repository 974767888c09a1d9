// An effect of an accelerometer, as the effects of gyros take it: its parameters and its table have g in the
// place of deg/s ("sigma_g" of "sigma_dps", "c1_g_per_C" of "c1_dps_per_C").
#pragma once

#include <optional>
#include <string>

#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// What 1 g is in deg/s, where so many rad/s stand for 1 m/s^2.
constexpr double dps_per_g(double rad_s_per_m_s2) {
    return standard_gravity_m_s2 * rad_s_per_m_s2 * deg_per_rad;
}

// Each is the other's inverse.
EffectModel as_gyro_effect(const EffectModel& of_accelerometer, double rad_s_per_m_s2);
EffectModel as_accelerometer_effect(const EffectModel& of_gyro, double rad_s_per_m_s2);

// As effect_refusal() of effect.hpp, in the accelerometer's names; also for a name of a gyro's parameter.
std::optional<std::string> accelerometer_effect_refusal(const EffectModel& of_accelerometer);

// "sigma_g" for "sigma_dps"; empty for a name without deg/s.
std::string accelerometer_param_name(const std::string& of_gyro);

}  // namespace gyrolog
