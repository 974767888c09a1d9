#include "analysis/simulate/sensor_model.hpp"

#include "analysis/recording/standard_gravity.hpp"

namespace gyrolog {

SensorModel typical_mpu9250() {
    constexpr Vector3 bias_dps = {0.31, -0.12, 0.08};
    SensorModel model;
    model.rate_hz = 100.0;
    model.full_scale_rad_s = 500.0 * rad_per_deg;
    model.lsb_rad_s = rad_per_deg / 65.5;
    model.saturation_rad_s = 32767.0 * model.lsb_rad_s;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        model.axes[axis].noise.N_rad_per_sqrt_s = 0.01 * rad_per_deg;
        model.axes[axis].noise.B_rad_per_s = 0.002 * rad_per_deg;
        model.axes[axis].noise.K_rad_per_s_sqrt_s = 1.0e-4 * rad_per_deg;
        model.axes[axis].bias_rad_s = bias_dps[axis] * rad_per_deg;
    }
    model.timestamp_jitter_s = 2.0e-6;
    model.sd_rel = {{"N", 0.005}, {"B", 0.08}, {"K", 0.20}, {"timestamp_jitter", 0.05}};
    model.sd_abs = {{"M", 2.0e-4}, {"latency_s", 1.0e-4}, {"rate_rel", 5.0e-5}};
    model.ref_noise_rad_s = 0.02 * rad_per_deg;
    model.acc_noise_m_s2 = 0.003 * standard_gravity_m_s2;
    model.temp_noise_C = 0.03;
    return model;
}

double clock_rate_sd_rel(const SensorModel& model) {
    constexpr double crystal_sd_rel = 5e-5;
    const auto stated = model.sd_abs.find("rate_rel");
    return stated == model.sd_abs.end() ? crystal_sd_rel : stated->second;
}

}  // namespace gyrolog
