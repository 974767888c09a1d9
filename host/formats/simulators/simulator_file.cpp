#include "host/formats/simulators/simulator_file.hpp"

#include "host/formats/simulators/simulator_texts.hpp"

namespace gyrolog {
namespace {

constexpr const SimulatorText* texts[] = {&xml_sensors_text, &airsim_settings_text, &kalibr_imu_text};

std::string_view without_mark(std::string_view text) {
    constexpr std::string_view utf8_mark = "\xef\xbb\xbf";
    return text.starts_with(utf8_mark) ? text.substr(utf8_mark.size()) : text;
}

}  // namespace

Result<std::unique_ptr<SimulatorFile>> open_simulator_file(std::string_view text) {
    const std::string_view inside = without_mark(text);
    for (const SimulatorText* kind : texts) {
        if (kind->begins_so(inside)) { return kind->open(inside); }
    }
    return std::unique_ptr<SimulatorFile>();
}

bool begins_as_simulator_file(std::string_view text) {
    for (const SimulatorText* kind : texts) {
        if (kind->begins_so(without_mark(text))) { return true; }
    }
    return false;
}

bool is_own_head(std::string_view comment) {
    const std::size_t from = comment.find_first_not_of("# \t\r\n");
    if (from == std::string_view::npos) { return false; }
    const std::string_view first = comment.substr(from, comment.find('\n', from) - from);
    return first.starts_with("From ") && first.find(", by gyrolog") != std::string_view::npos;
}

}  // namespace gyrolog
