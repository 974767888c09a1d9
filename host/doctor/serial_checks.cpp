#include <algorithm>
#include <string>
#include <string_view>

#include "host/doctor/checks.hpp"

namespace gyrolog {
namespace {

bool is_running(const Machine& machine, std::string_view program) {
    for (const std::string& name : machine.names("/proc")) {
        if (name.find_first_not_of("0123456789") != std::string::npos) { continue; }
        std::string running = machine.text("/proc/" + name + "/comm");
        running.erase(std::min(running.find('\n'), running.size()));
        if (running == program) { return true; }
    }
    return false;
}

}  // namespace

Diagnostic check_modem_manager(const Machine& machine, const DoctorOptions& /*options*/) {
    if (!is_running(machine, "ModemManager")) { return {true, "does not run", ""}; }
    if (!udev_rule(machine).empty()) { return {true, "runs, and the udev rule keeps it off the boards", ""}; }
    return {false, "runs, and sends modem commands to each serial port that appears, the boards' among them",
            install_udev_rule};
}

// Only for `--device tty:`; `usb:` takes the board from whatever driver has it.
Diagnostic check_cdc_acm(const Machine& machine, const DoctorOptions& /*options*/) {
    if (machine.has("/sys/bus/usb/drivers/cdc_acm")) { return {true, "loaded", ""}; }
    const std::string modules = "/lib/modules/" + machine.kernel_release;
    for (const char* list : {"/modules.dep", "/modules.builtin"}) {
        const std::string text = machine.text(modules + list);
        if (text.find("/cdc-acm.ko") != std::string::npos) {
            return {true, "there, and loaded when a board is plugged in", ""};
        }
    }
    if (!machine.has(modules)) {
        return {true, "not known: this kernel's modules are not here; --device tty: needs it, usb: does not",
                ""};
    }
    return {false, "not among the kernel's modules: --device tty: does not work, usb: does",
            "sudo apt install linux-image-amd64    # then start the machine anew"};
}

}  // namespace gyrolog
