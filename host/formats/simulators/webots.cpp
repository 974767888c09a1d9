#include <fmt/format.h>

#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

constexpr std::string_view webots_facts[] = {
    "resolution is in rad/s, after the lookup table, which ends at full scale (Webots, "
    "docs/reference/gyro.md, "
    "013d9359ef73).",
};

std::string webots_text(const SimulatorSource& source, std::span<const std::string> head) {
    std::string text = commented(head, "#") + "Gyro {\n  name \"gyro\"\n";
    if (source.full_scale_rad_s > 0.0) {
        text += fmt::format("  lookupTable [ -{0:.9g} -{0:.9g} 0, {0:.9g} {0:.9g} 0 ]  # rad/s\n",
                            source.full_scale_rad_s);
    }
    if (source.lsb_rad_s > 0.0) { text += fmt::format("  resolution {:.9g}  # rad/s\n", source.lsb_rad_s); }
    return text + "}\n";
}

}  // namespace

constinit const SimulatorFormat webots_format = {
    .name = "webots",
    .summary = "Webots: a Gyro node with range and resolution",
    .abilities = {.noise = std::nullopt, .bias = false, .rounds = true, .clips = true},
    .facts = webots_facts,
    .text = webots_text,
};

}  // namespace gyrolog
