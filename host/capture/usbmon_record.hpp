// A transfer as the Linux kernel's usbmon tells it: a header of 64 bytes, then the data (link type 220,
// LINKTYPE_USB_LINUX_MMAPPED; struct usbmon_packet in Documentation/usb/usbmon.rst). FORMAT.md, section 4.
#pragma once

#include <cstdint>
#include <optional>

#include "host/base/bytes.hpp"
#include "host/transport/transfer.hpp"

namespace gyrolog {

constexpr std::uint32_t link_type_usb_linux_mmapped = 220;
constexpr std::size_t usbmon_header_bytes = 64;

struct UsbAddress {
    std::uint16_t bus = 0;
    std::uint8_t device = 0;

    bool operator==(const UsbAddress&) const = default;
};

// `time_ns` since the Unix epoch; the record keeps microseconds.
void append_usbmon_record(Bytes& out, const Transfer& transfer, UsbAddress address, std::int64_t time_ns);

struct UsbmonRecord {
    Transfer transfer;  // views the packet; without time; the kind may be one that Transfer does not name
    UsbAddress address;
    std::int64_t time_us = 0;        // since the Unix epoch
    std::uint32_t actual_bytes = 0;  // of a completion, captured or not
    bool is_error_event = false;     // usbmon's 'E': the submission failed
};

// No value when the packet is no usbmon record: an unknown event or transfer type, or lengths that disagree.
std::optional<UsbmonRecord> read_usbmon_record(ByteView packet);

}  // namespace gyrolog
