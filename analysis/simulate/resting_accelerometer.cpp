#include "analysis/simulate/resting_accelerometer.hpp"

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/accelerometer_effect.hpp"

namespace gyrolog {

SensorModel exposed_accelerometer(const SensorModel& model) {
    const AccelerometerModel& accelerometer = *model.accelerometer;
    SensorModel sensor;
    sensor.rate_hz = model.rate_hz;
    sensor.full_scale_rad_s = accelerometer.full_scale_m_s2;
    sensor.lsb_rad_s = accelerometer.lsb_m_s2;
    sensor.saturation_rad_s = accelerometer.saturation_m_s2;
    sensor.axes = accelerometer.axes;
    sensor.M = accelerometer.M;
    for (const EffectModel& effect : accelerometer.effects) {
        sensor.effects.push_back(as_gyro_effect(effect, 1.0));
    }
    return sensor;
}

SensorModel resting_accelerometer(const SensorModel& model) {
    SensorModel sensor = exposed_accelerometer(model);
    for (std::size_t axis = 0; axis < sensor.axes.size(); ++axis) {
        sensor.axes[axis].bias_rad_s += sensor.M[axis][2] * standard_gravity_m_s2;
    }
    sensor.M = identity_matrix;
    return sensor;
}

}  // namespace gyrolog
