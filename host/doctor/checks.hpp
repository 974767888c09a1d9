// The doctor's checks: one function each, one line in doctor.cpp.
#pragma once

#include "host/doctor/doctor.hpp"

namespace gyrolog {

using Check = Diagnostic (*)(const Machine& machine, const DoctorOptions& options);

// usb_checks.cpp
Diagnostic check_usb(const Machine& machine, const DoctorOptions& options);
Diagnostic check_udev_rule(const Machine& machine, const DoctorOptions& options);
Diagnostic check_groups(const Machine& machine, const DoctorOptions& options);
Diagnostic check_boards(const Machine& machine, const DoctorOptions& options);
Diagnostic check_usbfs_memory(const Machine& machine, const DoctorOptions& options);
// serial_checks.cpp
Diagnostic check_modem_manager(const Machine& machine, const DoctorOptions& options);
Diagnostic check_cdc_acm(const Machine& machine, const DoctorOptions& options);
// computer_checks.cpp
Diagnostic check_disk_space(const Machine& machine, const DoctorOptions& options);
Diagnostic check_disk_sync(const Machine& machine, const DoctorOptions& options);
Diagnostic check_fonts(const Machine& machine, const DoctorOptions& options);
Diagnostic check_clock(const Machine& machine, const DoctorOptions& options);

// The file of the udev rule that counts and knows the boards; empty: there is none.
std::string udev_rule(const Machine& machine);
// The program writes its own copy: where a file of it lies depends on how the program came here.
inline constexpr const char* install_udev_rule =
    "gyrolog doctor --udev-rule | sudo tee /etc/udev/rules.d/60-gyrolog.rules > /dev/null && sudo udevadm "
    "control --reload && sudo udevadm trigger";

}  // namespace gyrolog
