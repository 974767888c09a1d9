#include "host/app/device_choice.hpp"

#include <algorithm>
#include <memory>

#include "host/base/counted.hpp"
#include "host/transport/source_uri.hpp"
#include "host/usb/usb_board.hpp"
#include "host/virtual_board/sim_options.hpp"

namespace gyrolog {
namespace {

constexpr const char* any_board = "usb:";
constexpr const char* all_boards = "usb:*";

bool has(const std::vector<std::string>& list, const std::string& one) {
    return std::ranges::find(list, one) != list.end();
}

// The boards on USB that no URI of `asked` names, in the order of their serial numbers.
Result<std::vector<std::string>> unnamed_boards(const std::vector<std::string>& asked) {
    GYROLOG_TRY(const std::unique_ptr<UsbContext> usb, UsbContext::create());
    GYROLOG_TRY(const UsbSurvey survey, survey_usb(*usb));
    std::vector<std::string> uris;
    for (const UsbBoard& board : survey.boards) {
        if (has(asked, board.uri())) { continue; }
        if (board.serial.empty()) {
            return Error{ErrorCode::invalid_argument,
                         "a board on USB has no serial number: only alone can it be captured"};
        }
        uris.push_back(board.uri());
    }
    return uris;
}

// "sim:rate=100,boards=3" as three, unless it says which of them it is.
Status add_simulated(const std::string& uri, std::vector<std::string>& chosen) {
    GYROLOG_TRY(const SourceUri parsed, parse_source_uri(uri));
    GYROLOG_TRY(const SimOptions options, parse_sim_options(parsed.options));
    const bool one_of_them =
        std::ranges::any_of(parsed.options, [](const auto& option) { return option.first == "board"; });
    if (one_of_them || options.boards == 1) {
        chosen.push_back(uri);
        return {};
    }
    for (unsigned board = 1; board <= options.boards; ++board) {
        chosen.push_back("sim:" + options.text + (options.text.empty() ? "" : ",") +
                         "boards=" + std::to_string(options.boards) + ",board=" + std::to_string(board));
    }
    return {};
}

}  // namespace

Result<std::vector<std::string>> choose_devices(const std::vector<std::string>& asked) {
    const auto times_any = std::ranges::count(asked, any_board);
    std::vector<std::string> unnamed;
    if (has(asked, all_boards) || (times_any > 0 && asked.size() > 1)) {
        GYROLOG_TRY(unnamed, unnamed_boards(asked));
        const auto wanted = has(asked, all_boards) ? std::ptrdiff_t{1} : times_any;
        if (static_cast<std::ptrdiff_t>(unnamed.size()) < wanted) {
            return Error{ErrorCode::not_found,
                         "asked for on USB: " + counted(static_cast<std::uint64_t>(wanted), "more board") +
                             "; there: " + counted(unnamed.size(), "board") + "; `gyrolog list` shows them"};
        }
    }
    std::vector<std::string> chosen;
    auto next = unnamed.begin();
    for (const std::string& uri : asked) {
        if (uri == all_boards) {
            chosen.insert(chosen.end(), next, unnamed.end());
            next = unnamed.end();
        } else if (uri == any_board && asked.size() > 1) {
            if (next != unnamed.end()) { chosen.push_back(*next++); }
        } else if (uri.starts_with("sim:")) {
            GYROLOG_CHECK(add_simulated(uri, chosen));
        } else {
            chosen.push_back(uri);
        }
    }
    for (auto uri = chosen.begin(); uri != chosen.end(); ++uri) {
        if (std::find(uri + 1, chosen.end(), *uri) != chosen.end() && !uri->starts_with("sim:")) {
            return Error{ErrorCode::invalid_argument, "--device '" + *uri + "' is given twice"};
        }
    }
    return chosen;
}

std::string path_of_board(const std::string& path, const std::string& serial, unsigned number) {
    const std::string ending = ".pcapng";
    const std::string stem = path.ends_with(ending) ? path.substr(0, path.size() - ending.size()) : path;
    std::string name = serial;
    std::ranges::replace(name, '/', '_');
    if (number > 0) { name += (name.empty() ? "" : "-") + std::to_string(number); }
    return stem + "-" + name + path.substr(stem.size());
}

std::string file_of_device(const std::string& uri) {
    const auto parsed = parse_source_uri(uri);
    if (!parsed.ok()) { return {}; }
    if (parsed->kind == SourceUri::Kind::replay) { return parsed->rest; }
    for (const auto& [key, value] : parsed->options) {
        if (key == "model") { return value; }
    }
    return {};
}

}  // namespace gyrolog
