#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view carla_facts[] = {
    "Noise is per tick of the sensor, so that sensor_tick belongs to it; the bias is constant (CARLA, "
    "Unreal/CarlaUE4/Plugins/Carla/Source/Carla/Sensor/InertialMeasurementUnit.cpp, ComputeGyroscopeNoise, "
    "001f560e0190).",
    "The angular velocity is that of Unreal's left-handed axes (the same file, ComputeGyroscope): y points "
    "to "
    "the right. Turn the model's axes if the sensor's are others.",
};

std::string carla_text(const SimulatorSource& source, std::span<const std::string> head) {
    std::string text =
        commented_for_python(head) +
        "\n\ndef set_imu(blueprint):\n    \"\"\"Of blueprint_library.find('sensor.other.imu').\"\"\"\n" +
        fmt::format("    blueprint.set_attribute(\"sensor_tick\", \"{:.9g}\")  # s\n", 1.0 / source.rate_hz);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        text += fmt::format(
            "    blueprint.set_attribute(\"noise_gyro_stddev_{0}\", \"{1:.9g}\")  # rad/s\n"
            "    blueprint.set_attribute(\"noise_gyro_bias_{0}\", \"{2:.9g}\")  # rad/s\n",
            axis_names[axis], source.sample_sd_rad_s(axis), source.bias_rad_s[axis]);
    }
    return text;
}

}  // namespace

constinit const SimulatorFormat carla_format = {
    .name = "carla",
    .summary = "CARLA: the attributes of sensor.other.imu, set in Python",
    .abilities = {.noise = ProjectedTerms::white},
    .facts = carla_facts,
    .text = carla_text,
};

}  // namespace gyrolog
