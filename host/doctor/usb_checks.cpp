#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/doctor/checks.hpp"

namespace gyrolog {
namespace {

constexpr const char* rule_name = "60-gyrolog.rules";
// In the order in which udev lets one hide the others (udev(7)).
constexpr std::array rule_folders{"/etc/udev/rules.d", "/run/udev/rules.d", "/usr/local/lib/udev/rules.d",
                                  "/usr/lib/udev/rules.d", "/lib/udev/rules.d"};
// Of the serial port, dialout; of the device, plugdev (tools/60-gyrolog.rules).
constexpr std::array wanted_groups{"plugdev", "dialout"};

std::string first_line(const Machine& machine, const std::string& path) {
    std::string text = machine.text(path);
    text.erase(std::min(text.find('\n'), text.size()));
    return text;
}

bool is_board(const Machine& machine, const std::string& device) {
    const std::string vendor = first_line(machine, device + "/idVendor");
    const std::string product = first_line(machine, device + "/idProduct");
    const bool is_id = (vendor == "1209" && product == "6779") || (vendor == "1fc9" && product == "0083");
    return is_id && first_line(machine, device + "/product").starts_with("gyrolog");
}

std::optional<unsigned> number_in(const Machine& machine, const std::string& path) {
    const std::string text = first_line(machine, path);
    unsigned number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size()) { return std::nullopt; }
    return number;
}

struct Group {
    std::optional<unsigned> id;  // none: there is no such group
    bool lists_user = false;
};

// A line of /etc/group: name, password, number, members.
Group find_group(const Machine& machine, const std::string& name) {
    const std::string text = "\n" + machine.text("/etc/group");
    const std::size_t begin = text.find("\n" + name + ":");
    if (begin == std::string::npos) { return {}; }
    const std::string line = text.substr(begin + 1, text.find('\n', begin + 1) - begin - 1);
    const std::size_t number_at = line.find(':', name.size() + 1) + 1;
    const std::size_t members_at = number_at == 0 ? std::string::npos : line.find(':', number_at);
    Group group;
    if (members_at == std::string::npos) { return group; }
    unsigned id = 0;
    if (std::from_chars(line.data() + number_at, line.data() + members_at, id).ec == std::errc()) {
        group.id = id;
    }
    const std::string members = "," + line.substr(members_at + 1) + ",";
    group.lists_user = !machine.user.empty() && members.find("," + machine.user + ",") != std::string::npos;
    return group;
}

}  // namespace

Diagnostic check_usb(const Machine& machine, const DoctorOptions& /*options*/) {
    if (!machine.has("/sys/bus/usb/devices")) {
        return {false, "the kernel shows no USB: no driver is loaded, or this is a container",
                "sudo modprobe usbcore"};
    }
    if (!machine.has("/dev/bus/usb")) {
        return {false, "there is USB but no /dev/bus/usb: a container that was not given it, or no udev",
                "docker run --privileged -v /dev/bus/usb:/dev/bus/usb ..."};
    }
    return {true, "USB devices are shown and can be opened by those who may", ""};
}

std::string udev_rule(const Machine& machine) {
    for (const char* folder : rule_folders) {
        const std::string path = std::string(folder) + "/" + rule_name;
        if (!machine.has(path)) { continue; }
        const std::string text = machine.text(path);  // one that leads to /dev/null switches the others off
        const bool knows_boards =
            text.find("1209") != std::string::npos && text.find("6779") != std::string::npos;
        return knows_boards ? path : std::string();
    }
    return {};
}

Diagnostic check_udev_rule(const Machine& machine, const DoctorOptions& /*options*/) {
    const std::string rule = udev_rule(machine);
    if (!rule.empty()) { return {true, rule + " opens the boards", ""}; }
    for (const char* folder : rule_folders) {
        const std::string path = std::string(folder) + "/" + rule_name;
        if (!machine.has(path)) { continue; }
        return {false, path + " does not know the boards' id 1209:6779: it is older, empty or switched off",
                install_udev_rule};
    }
    return {false, "no udev rule opens the boards, nor keeps other programs off them", install_udev_rule};
}

Diagnostic check_groups(const Machine& machine, const DoctorOptions& /*options*/) {
    if (machine.is_root) { return {true, "root may open every device", ""}; }
    if (!machine.seat.empty()) {
        return {true, "whoever sits at " + printable(machine.seat) + " may open the boards, by the udev rule",
                ""};
    }
    for (const std::string name : wanted_groups) {
        const Group group = find_group(machine, name);
        if (!group.id) {
            return {false, "nobody sits at this machine's seat (ssh?), and there is no group " + name,
                    "sudo groupadd --system " + name};
        }
        if (std::ranges::count(machine.groups, *group.id) > 0) { continue; }
        if (group.lists_user) {
            return {false, "the user is in the group " + name + ", but not yet in this session",
                    "newgrp " + name + "    # or log in again"};
        }
        return {false, "nobody sits at this machine's seat (ssh?), and the user is not in the group " + name,
                "sudo adduser " + (machine.user.empty() ? "$USER" : machine.user) + " " + name +
                    "    # then log in again"};
    }
    return {true, "the user is in the groups plugdev and dialout", ""};
}

Diagnostic check_boards(const Machine& machine, const DoctorOptions& /*options*/) {
    std::size_t boards = 0;
    for (const std::string& name : machine.names("/sys/bus/usb/devices")) {
        const std::string device = "/sys/bus/usb/devices/" + name;
        if (!is_board(machine, device)) { continue; }
        ++boards;
        const auto bus = number_in(machine, device + "/busnum");
        const auto number = number_in(machine, device + "/devnum");
        if (!bus || !number) { continue; }
        const std::string node = fmt::format("/dev/bus/usb/{:03}/{:03}", *bus, *number);
        if (machine.may_open(machine.at(node))) { continue; }
        return {false,
                fmt::format("the board {} at {} may not be opened",
                            printable(first_line(machine, device + "/serial")), node),
                udev_rule(machine).empty() ? install_udev_rule
                                           : "sudo udevadm trigger    # or plug the board in again"};
    }
    if (boards == 0) { return {true, "none is plugged in, so none was tried", ""}; }
    return {true, counted(boards, "board") + " may be opened", ""};
}

Diagnostic check_usbfs_memory(const Machine& machine, const DoctorOptions& options) {
    const std::string path = "/sys/module/usbcore/parameters/usbfs_memory_mb";
    const auto limit_mb = number_in(machine, path);
    if (!limit_mb) { return {true, "the kernel states no limit", ""}; }
    if (*limit_mb == 0) { return {true, "no limit", ""}; }
    if (*limit_mb >= options.usbfs_mb_least) {
        return {true, fmt::format("{} MB, and each board takes 4 MB at most", *limit_mb), ""};
    }
    return {false, fmt::format("{} MB for all transfers under way, and each board may take 4 MB", *limit_mb),
            fmt::format("echo {} | sudo tee {}", options.usbfs_mb_least, path)};
}

}  // namespace gyrolog
