#include "host/doctor/doctor.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "host/doctor/checks.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

struct NamedCheck {
    const char* name;
    Check check;
};

constexpr std::array all_checks{
    NamedCheck{"USB", check_usb},
    NamedCheck{"udev rule", check_udev_rule},
    NamedCheck{"groups", check_groups},
    NamedCheck{"boards", check_boards},
    NamedCheck{"usbfs memory", check_usbfs_memory},
    NamedCheck{"ModemManager", check_modem_manager},
    NamedCheck{"cdc_acm", check_cdc_acm},
    NamedCheck{"disk space", check_disk_space},
    NamedCheck{"disk sync", check_disk_sync},
    NamedCheck{"fonts", check_fonts},
    NamedCheck{"clock", check_clock},
};

}  // namespace

std::vector<NamedDiagnostic> examine(const Machine& machine, const DoctorOptions& options) {
    std::vector<NamedDiagnostic> found;
    found.reserve(all_checks.size());
    for (const NamedCheck& one : all_checks) { found.push_back({one.name, one.check(machine, options)}); }
    return found;
}

bool nothing_in_the_way(const std::vector<NamedDiagnostic>& found) {
    return std::ranges::all_of(found, [](const NamedDiagnostic& one) { return one.found.fine; });
}

std::string doctor_text(const std::vector<NamedDiagnostic>& found) {
    std::string text;
    for (const NamedDiagnostic& one : found) {
        text += fmt::format("{:<8} {:<13} {}\n", one.found.fine ? "ok" : "problem", one.name, one.found.what);
        if (!one.found.command.empty()) { text += fmt::format("{:<22} {}\n", "", one.found.command); }
    }
    const auto problems = std::ranges::count_if(found, [](const auto& one) { return !one.found.fine; });
    return text + (problems == 0 ? "nothing stands in the way\n"
                                 : fmt::format("{} in the way; below each stands what mends it\n",
                                               problems == 1 ? "one problem is"
                                                             : fmt::format("{} problems are", problems)));
}

Json doctor_json(const std::vector<NamedDiagnostic>& found) {
    Json json;
    json["schema"] = "gyrolog-doctor/1";
    json["ok"] = nothing_in_the_way(found);
    json["checks"] = Json::array();
    for (const NamedDiagnostic& one : found) {
        Json check{{"name", one.name}, {"ok", one.found.fine}, {"what", one.found.what}};
        if (!one.found.command.empty()) { check["command"] = one.found.command; }
        json["checks"].push_back(std::move(check));
    }
    return json;
}

}  // namespace gyrolog
