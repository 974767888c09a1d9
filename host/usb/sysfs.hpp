// The kernel's files about devices. It read strings and descriptors when the device was plugged in and shows
// them to everybody, so a board can be named even when it may not be opened, and nothing disturbs one that is
// streaming.
#pragma once

#include <string>

#include "host/base/bytes.hpp"

namespace gyrolog {

// What the file `name` in `directory` holds; empty when there is no such file.
Bytes read_sysfs_bytes(const std::string& directory, const char* name);
// The same without the line's end and blanks before it.
std::string read_sysfs_text(const std::string& directory, const char* name);
// The same as a number to this base, 0 when there is none.
unsigned long read_sysfs_number(const std::string& directory, const char* name, int base);

}  // namespace gyrolog
