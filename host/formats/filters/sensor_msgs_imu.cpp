#include <optional>

#include <fmt/format.h>

#include "host/formats/filters/filter_number.hpp"
#include "host/formats/filters/filters.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view message_facts[] = {
    "A covariance is that of the white noise of one message, N^2 * rate, on its diagonal. It is no longer "
    "true "
    "of messages at another rate: driver filters and decimation change it.",
    "The first element of orientation_covariance is -1: there is no orientation (sensor_msgs/msg/Imu.msg). "
    "Zeros would mean that a covariance is not known.",
    "The error of the bias is in none of these: it is the same in each message, and averaging does not "
    "reduce it.",
};

constexpr std::string_view robot_localization_facts[] = {
    "robot_localization takes nothing of an IMU from its own parameters: process_noise_covariance is of the "
    "vehicle's motion. It takes the covariances in sensor_msgs/Imu; set these in the IMU's driver.",
    "It takes each message for an independent measurement and has no state for a bias: what the bias is off, "
    "it follows, with a confidence that grows without limit.",
    "A variance below 1e-9 is taken for 1e-9 there, and a negative one for its absolute value (src/ekf.cpp, "
    "correct, 0108d3f47a41).",
    "A covariance is N^2 * rate, that of one message's white noise.",
};

constexpr FilterNumber sensor_msgs_imu_numbers[] = {
    {"angular_velocity_covariance", SensorKind::gyro, NoiseTerm::N, "(rad/s)^2", once_a_sample},
    {"linear_acceleration_covariance", SensorKind::accelerometer, NoiseTerm::N, "(m/s^2)^2", once_a_sample},
};

// Of an axis that was not measured, the largest of the others.
double variance(const FilterTerm& term, std::string_view axis, double rate_hz) {
    double density = *term.value;
    for (const ExportedAxis& one : term.of_axes) {
        if (one.name == axis && one.N.identified) { density = one.N.value; }
    }
    return density * density * rate_hz;
}

std::string imu_text(const FilterSource& source) {
    std::string text = "orientation_covariance: [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]\n";
    for (const FilterNumber& number : sensor_msgs_imu_numbers) {
        const FilterTerm& term = source.term(number.sensor, number.term);
        text += fmt::format("# {}; axes of N: {}\n", number.unit, term.axes);
        if (!term.value) {
            text += fmt::format("# {}: not known\n", number.key);
            continue;
        }
        text += fmt::format("{}: [{}, 0.0, 0.0, 0.0, {}, 0.0, 0.0, 0.0, {}]\n", number.key,
                            real_text(variance(term, "x", source.rate_hz)),
                            real_text(variance(term, "y", source.rate_hz)),
                            real_text(variance(term, "z", source.rate_hz)));
    }
    return text;
}

}  // namespace

constinit const FilterFormat sensor_msgs_imu_format = {
    .name = "sensor-msgs-imu",
    .summary = "ROS: the covariances of sensor_msgs/Imu, in YAML",
    .kind = "Discrete at {rate} Hz.",
    .facts = message_facts,
    .numbers = sensor_msgs_imu_numbers,
    .line = "",
    .before = "",
    .after = "",
    .text = imu_text,
};

constinit const FilterFormat robot_localization_format = {
    .name = "robot-localization",
    .summary = "robot_localization: the covariances of sensor_msgs/Imu that it takes, in YAML",
    .kind = "Discrete at {rate} Hz.",
    .facts = robot_localization_facts,
    .numbers = sensor_msgs_imu_numbers,
    .line = "",
    .before = "",
    .after = "",
    .text = imu_text,
};

}  // namespace gyrolog
