#include "host/formats/filters/filter_number.hpp"
#include "host/formats/filters/filters.hpp"

namespace gyrolog {
namespace {

constexpr int px4_ekf2_step_rate_hz = 100;

constexpr std::string_view px4_ekf2_facts[] = {
    "EKF2 adds (number * dt)^2 in each of its steps, for noises and for biases (PX4-Autopilot, "
    "src/modules/ekf2/EKF/covariance.cpp, predictCovariance, 028733e1c7eb). Its unit says rad/s, what it "
    "means "
    "depends on the step: N / sqrt(dt) and K / sqrt(dt) here, for the 10 ms that EKF2_PREDICT_US has without "
    "change (ekf2_params.c, 0290a619e161). For another step multiply all four by sqrt(10 ms / step).",
    "A number above 1 is taken for 1 there. EKF2_GYR_NOISE from 0.0001 to 0.1, EKF2_ACC_NOISE from 0.01 to 1 "
    "and biases up to 0.01 is what a ground station lets through.",
    "The variance of the accelerometer's bias is not let below 5e-8 / dt^2, which is (0.022 m/s^2)^2 at 10 "
    "ms "
    "(fixCovarianceErrors of the same file): a smaller EKF2_ACC_B_NOISE acts only above that.",
};

constexpr FilterNumber px4_ekf2_numbers[] = {
    {"EKF2_GYR_NOISE", SensorKind::gyro, NoiseTerm::N, "rad/s", once_a_step<px4_ekf2_step_rate_hz>, 1.0},
    {"EKF2_ACC_NOISE", SensorKind::accelerometer, NoiseTerm::N, "m/s^2", once_a_step<px4_ekf2_step_rate_hz>,
     1.0},
    {"EKF2_GYR_B_NOISE", SensorKind::gyro, NoiseTerm::K, "rad/s^2", once_a_step<px4_ekf2_step_rate_hz>, 1.0},
    {"EKF2_ACC_B_NOISE", SensorKind::accelerometer, NoiseTerm::K, "m/s^3", once_a_step<px4_ekf2_step_rate_hz>,
     1.0},
};

}  // namespace

constinit const FilterFormat px4_ekf2_format = {
    .name = "px4-ekf2",
    .summary = "PX4's EKF2: lines of a .params file",
    .kind = "Discrete at 100 Hz, the filter's step; the rate of the sensor does not matter.",
    .facts = px4_ekf2_facts,
    .numbers = px4_ekf2_numbers,
    .line = "1\t1\t{key}\t{value}\t9",  // vehicle, component, name, value, type: a 32 bit float
    .before = "",
    .after = "",
};

}  // namespace gyrolog
