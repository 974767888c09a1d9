// What the recording program and the replayed one must do alike for the replay to go on.
#pragma once

#include <array>
#include <cstdint>

#include "host/usb/bulk_in_stream.hpp"

namespace gyrolog::test {

// 16 samples a frame at 1 kHz.
inline const BulkInPlan recording_plan = BulkInPlan::for_short_packets(62.5);

// GET_HELLO with the sequence number 1, as it goes over the wire (SPEC.md, 4.1).
inline constexpr std::array<std::uint8_t, 15> command_before_the_stream = {
    0x00, 0x03, 0x01, 0x81, 0x01, 0x02, 0x01, 0x01, 0x01, 0x05, 0xD4, 0x59, 0x55, 0x3F, 0x00};

}  // namespace gyrolog::test
