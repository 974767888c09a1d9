#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "host/app/command.hpp"
#include "host/app/former_id.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/base/printable.hpp"
#include "host/formats/json.hpp"
#include "host/usb/usb_board.hpp"

namespace gyrolog {
namespace {

struct ListOptions {
    std::string json;
};

// Boards, and behind them the strangers, with what tells them from one.
std::vector<UsbBoard> listed(const UsbSurvey& survey) {
    std::vector<UsbBoard> devices = survey.boards;
    devices.insert(devices.end(), survey.strangers.begin(), survey.strangers.end());
    return devices;
}

Json list_json(const UsbSurvey& survey) {
    auto devices = Json::array();
    for (const UsbBoard& board : listed(survey)) {
        devices.push_back({{"uri", board.uri()},
                           {"vid", fmt::format("{:04x}", board.vendor_id)},
                           {"pid", fmt::format("{:04x}", board.product_id)},
                           {"serial", board.serial},
                           {"state", board_state_name(board.state)},
                           {"why", board.why}});
    }
    return {{"schema", "gyrolog-list/1"}, {"devices", devices}};
}

std::string list_text(const UsbSurvey& survey) {
    std::string text;
    for (const UsbBoard& board : listed(survey)) {
        text += fmt::format("{:<20} {:04x}:{:04x}  {:<28} {}\n", printable(board.uri()), board.vendor_id,
                            board.product_id,
                            board.product.empty() ? "(name not readable)" : printable(board.product),
                            board_state_name(board.state));
        if (!board.why.empty()) { text += "    " + board.why + '\n'; }
    }
    return text;
}

ExitCode list(Console& console, const ListOptions& options) {
    const NamedPath written[] = {{"--json", options.json}};
    if (const Status fine = check_output_paths({}, written); !fine.ok()) {
        return report_error(console, "list", fine.error());
    }
    auto usb = UsbContext::create();
    if (!usb.ok()) { return report_error(console, "list", usb.error()); }
    const auto survey = survey_usb(**usb);
    if (!survey.ok()) { return report_error(console, "list", survey.error()); }
    ResultOutput results(console);
    if (options.json != "-") { results.show(list_text(*survey)); }
    results.json(options.json, [&] { return list_json(*survey); });
    if (const Status done = results.finish(); !done.ok()) {
        return report_error(console, "list", done.error());
    }
    for (const UsbBoard& board : survey->boards) {
        warn_of_former_id(console, "list", board.uri(), board.vendor_id, board.product_id);
    }
    if (survey->boards.empty()) {
        const auto none = choose_board(*survey, "");
        console.err << "gyrolog list: " << printable(none.error().message) << '\n';
    }
    const bool usable = std::ranges::any_of(
        survey->boards, [](const UsbBoard& board) { return board.state == BoardState::ready; });
    return usable ? ExitCode::ok : ExitCode::no_device;
}

}  // namespace

Action setup_list(CLI::App& app) {
    auto options = std::make_shared<ListOptions>();
    app.add_option("--json", options->json, "Write the answer as JSON to FILE (- for standard output)")
        ->type_name("FILE");
    return [options](Console& console) { return list(console, *options); };
}

}  // namespace gyrolog
