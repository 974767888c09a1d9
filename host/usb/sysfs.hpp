// The kernel's files about devices. It read strings and descriptors when the device was plugged in and shows
// them to everybody, so a board can be named even when it may not be opened, and nothing disturbs one that is
// streaming.
#pragma once

#include <string>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"
#include "host/usb/cdc_descriptors.hpp"

namespace gyrolog {

// What the file `name` in `directory` holds; empty when there is no such file.
Bytes read_sysfs_bytes(const std::string& directory, const char* name);
// The same without the line's end and blanks before it.
std::string read_sysfs_text(const std::string& directory, const char* name);
// The same as a number to this base, 0 when there is none.
unsigned long read_sysfs_number(const std::string& directory, const char* name, int base);

struct UsbDescriptors {
    Bytes device;
    Bytes configuration;  // the one that is set
    CdcLayout layout;
};

// Of the USB device of this directory. Errors: those of find_configuration() and parse_cdc_configuration();
// `unsupported` when no configuration is set.
Result<UsbDescriptors> read_usb_descriptors(const std::string& directory);

}  // namespace gyrolog
