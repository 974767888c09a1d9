#include "host/virtual_board/usb_descriptors.hpp"

#include <initializer_list>

#include <gyrolog_protocol/usb_identity.h>

namespace gyrolog {

namespace {

enum DescriptorType : std::uint8_t {
    type_device = 1,
    type_configuration = 2,
    type_string = 3,
    type_interface = 4,
    type_endpoint = 5,
    type_cs_interface = 0x24,
};
enum StringIndex : std::uint8_t {
    no_string = 0,
    manufacturer_string = 1,
    product_string = 2,
    serial_number_string = 3
};
enum EndpointKind : std::uint8_t { bulk = 2, interrupt = 3 };

constexpr std::uint8_t class_communications = 0x02;
constexpr std::uint8_t class_data = 0x0A;
constexpr std::uint8_t subclass_abstract_control = 0x02;
constexpr std::uint16_t english_us = 0x0409;

std::uint8_t low(unsigned value) { return static_cast<std::uint8_t>(value); }
std::uint8_t high(unsigned value) { return static_cast<std::uint8_t>(value >> 8U); }

// Appends a descriptor: its length goes in front.
void append(Bytes& to, std::initializer_list<std::uint8_t> fields) {
    to.push_back(static_cast<std::uint8_t>(fields.size() + 1));
    to.insert(to.end(), fields);
}

void append_endpoint(Bytes& to, std::uint8_t address, EndpointKind kind, unsigned packet_bytes,
                     std::uint8_t interval_ms) {
    append(to, {type_endpoint, address, kind, low(packet_bytes), high(packet_bytes), interval_ms});
}

}  // namespace

Bytes device_descriptor() {
    constexpr unsigned usb_version = 0x0200;
    constexpr unsigned device_version = 0x0100;
    Bytes bytes;
    append(bytes, {type_device, low(usb_version), high(usb_version), class_communications, 0, 0,
                   GLP_USB_PACKET_BYTES, low(GLP_USB_VENDOR_ID), high(GLP_USB_VENDOR_ID),
                   low(GLP_USB_PRODUCT_ID), high(GLP_USB_PRODUCT_ID), low(device_version),
                   high(device_version), manufacturer_string, product_string, serial_number_string, 1});
    return bytes;
}

Bytes configuration_descriptor(const UsbEndpoints& endpoints) {
    constexpr unsigned cdc_version = 0x0110;
    constexpr std::uint8_t bus_powered = 0x80;
    constexpr std::uint8_t max_power_2mA = 50;
    constexpr std::uint8_t line_coding_and_state = 0x02;  // the requests of ACM that the board takes
    Bytes parts;
    append(parts, {type_interface, GLP_USB_INTERFACE_CONTROL, 0, 1, class_communications,
                   subclass_abstract_control, 0, no_string});
    append(parts, {type_cs_interface, 0x00, low(cdc_version), high(cdc_version)});  // header
    append(parts, {type_cs_interface, 0x01, 0x00, GLP_USB_INTERFACE_DATA});         // call management: none
    append(parts, {type_cs_interface, 0x02, line_coding_and_state});                // abstract control
    append(parts, {type_cs_interface, 0x06, GLP_USB_INTERFACE_CONTROL, GLP_USB_INTERFACE_DATA});  // union
    append_endpoint(parts, endpoints.notify, interrupt, 8, 16);
    append(parts, {type_interface, GLP_USB_INTERFACE_DATA, 0, 2, class_data, 0, 0, no_string});
    append_endpoint(parts, endpoints.in, bulk, GLP_USB_PACKET_BYTES, 0);
    append_endpoint(parts, endpoints.out, bulk, GLP_USB_PACKET_BYTES, 0);

    constexpr unsigned header_bytes = 9;
    const auto total = static_cast<unsigned>(parts.size()) + header_bytes;
    Bytes bytes;
    append(bytes, {type_configuration, low(total), high(total), 2, 1, no_string, bus_powered, max_power_2mA});
    bytes.insert(bytes.end(), parts.begin(), parts.end());
    return bytes;
}

std::optional<Bytes> string_descriptor(std::uint8_t index, std::string_view serial) {
    Bytes bytes = {0, type_string};
    std::string_view text;
    switch (index) {
        case no_string:
            bytes.push_back(low(english_us));
            bytes.push_back(high(english_us));
            break;
        case manufacturer_string:
            text = virtual_board_manufacturer;
            break;
        case product_string:
            text = virtual_board_product;
            break;
        case serial_number_string:
            text = serial;
            break;
        default:
            return std::nullopt;
    }
    for (const char character : text) {  // ASCII as UTF-16
        bytes.push_back(static_cast<std::uint8_t>(character));
        bytes.push_back(0);
    }
    bytes[0] = static_cast<std::uint8_t>(bytes.size());
    return bytes;
}

}  // namespace gyrolog
