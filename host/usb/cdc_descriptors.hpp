// Reads a USB device's descriptors as far as a CDC-ACM board needs: which interfaces to claim, which
// endpoints to use. Layouts: USB 2.0 section 9.6 (device, configuration, interface, endpoint); USB CDC 1.2
// section 5.2.3.2 (union).
#pragma once

#include <cstdint>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct CdcLayout {
    std::uint8_t configuration = 0;  // bConfigurationValue
    std::uint8_t control_interface = 0;
    std::uint8_t data_interface = 0;
    std::uint8_t endpoint_in = 0;  // with the direction bit 0x80
    std::uint8_t endpoint_out = 0;
    std::uint16_t packet_in_bytes = 0;  // requests on endpoint_in must be a multiple of it
    std::uint16_t packet_out_bytes = 0;
};

inline constexpr std::size_t device_descriptor_bytes = 18;

// The configuration with the given value out of `descriptors`: the device descriptor followed by every
// configuration, as sysfs's file `descriptors` holds them. The result is a view into `descriptors`. Errors:
// `malformed` when a length runs past the end; `not_found` when there is no such configuration.
Result<ByteView> find_configuration(ByteView descriptors, std::uint8_t configuration);

// Errors: `malformed` when the bytes break USB's own rules; `unsupported` when they describe something that
// is not a CDC-ACM function with one bulk endpoint each way.
Result<CdcLayout> parse_cdc_configuration(ByteView configuration);

}  // namespace gyrolog
