#include "host/formats/simulators/simulator_format.hpp"

#include <algorithm>
#include <array>

#include "host/formats/python_encoding.hpp"
#include "host/formats/simulators/simulators.hpp"

namespace gyrolog {
namespace {

constexpr std::array<const SimulatorFormat*, 13> formats = {
    &sdf_format,          &px4_classic_format, &rotors_format,  &pegasus_format, &isaaclab_format,
    &mjcf_format,         &airsim_format,      &genesis_format, &carla_format,   &jmavsim_format,
    &gnss_ins_sim_format, &navego_format,      &webots_format,
};

}  // namespace

std::span<const SimulatorFormat* const> simulator_formats() { return formats; }

const SimulatorFormat* find_simulator_format(std::string_view name) {
    const auto* const found =
        std::ranges::find_if(formats, [&](const SimulatorFormat* format) { return format->name == name; });
    return found == formats.end() ? nullptr : *found;
}

std::string simulator_text(const SimulatorFormat& format, const SensorModel& model, const std::string& name,
                           double horizon_s) {
    const SimulatorSource source = simulator_source(model, name, format.abilities, horizon_s);
    std::vector<std::string> head = head_lines(source, format.abilities);
    for (const std::string_view fact : format.facts) { head.emplace_back(fact); }
    return format.text(source, head);
}

std::string commented(std::span<const std::string> head, std::string_view sign) {
    std::string text;
    for (const std::string& line : head) { text += std::string(sign) + ' ' + line + '\n'; }
    return text;
}

std::string commented_for_python(std::span<const std::string> head) {
    return std::string(python_encoding_line) + commented(head, "#");
}

std::string xml_comment(std::span<const std::string> head) {
    std::string text = "\n";
    for (std::string line : head) {
        // Two dashes end an XML comment.
        for (auto dashes = line.find("--"); dashes != std::string::npos; dashes = line.find("--")) {
            line.replace(dashes, 2, "- -");
        }
        text += "  " + line + '\n';
    }
    return text;
}

}  // namespace gyrolog
