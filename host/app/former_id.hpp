// Boards whose firmware still has the id of NXP's example of a serial port.
#pragma once

#include <cstdint>
#include <string>

#include "host/app/console.hpp"
#include "host/transport/byte_source.hpp"

namespace gyrolog {

// Says on `err` which id the firmware should have; nothing when it has it.
void warn_of_former_id(Console& console, const char* command, const std::string& uri, std::uint16_t vendor_id,
                       std::uint16_t product_id);
// The same for a device that is plugged in. An old capture that is replayed keeps its id.
void warn_of_former_id(Console& console, const char* command, const SourceIdentity& identity);

}  // namespace gyrolog
