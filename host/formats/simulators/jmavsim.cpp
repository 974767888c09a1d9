#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view jmavsim_facts[] = {
    "jMAVSim reads no file: the line below belongs where the sensors are made. Noise is per reading, one "
    "number "
    "for all axes; there is no bias (jMAVSim, src/me/drton/jmavsim/SimpleSensors.java, getGyro and "
    "addZeroMeanNoise).",
};

std::string jmavsim_text(const SimulatorSource& source, std::span<const std::string> head) {
    return commented(head, "//") +
           fmt::format("sensors.setNoise_Gyo({:.9g}f);  // rad/s\n", source.sample_sd_rad_s(0));
}

}  // namespace

constinit const SimulatorFormat jmavsim_format = {
    .name = "jmavsim",
    .summary = "jMAVSim: the noise of the gyro, a line of Java",
    .abilities = {.noise = ProjectedTerms::white, .per_axis = false, .bias = false},
    .facts = jmavsim_facts,
    .text = jmavsim_text,
};

}  // namespace gyrolog
