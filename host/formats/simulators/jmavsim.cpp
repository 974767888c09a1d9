#include <algorithm>
#include <string>
#include <vector>

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

// Java takes \u000a for the end of a line in a comment, too.
std::vector<std::string> without_escapes(std::span<const std::string> lines) {
    std::vector<std::string> plain(lines.begin(), lines.end());
    for (std::string& line : plain) { std::ranges::replace(line, '\\', '/'); }
    return plain;
}

std::string jmavsim_text(const SimulatorSource& source, std::span<const std::string> head) {
    return commented(without_escapes(head), "//") +
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
