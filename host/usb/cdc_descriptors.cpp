#include "host/usb/cdc_descriptors.hpp"

#include <optional>
#include <string>

namespace gyrolog {
namespace {

constexpr std::uint8_t type_configuration = 0x02;
constexpr std::uint8_t type_interface = 0x04;
constexpr std::uint8_t type_endpoint = 0x05;
constexpr std::uint8_t type_class_specific_interface = 0x24;
constexpr std::uint8_t subtype_union = 0x06;
constexpr std::uint8_t class_communications = 0x02;
constexpr std::uint8_t subclass_abstract_control_model = 0x02;
constexpr std::uint8_t class_data = 0x0A;
constexpr std::uint8_t endpoint_direction_in = 0x80;
constexpr std::uint8_t transfer_type_mask = 0x03;
constexpr std::uint8_t transfer_type_bulk = 0x02;
constexpr std::uint16_t packet_bytes_mask =
    0x07FF;  // the bits above count transactions of high-speed isochronous

constexpr std::size_t configuration_bytes_min = 9;
constexpr std::size_t interface_bytes_min = 9;
constexpr std::size_t endpoint_bytes_min = 7;
constexpr std::size_t union_bytes_min = 5;

std::uint16_t load_u16(ByteView bytes, std::size_t at) {
    return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8U));
}

Error malformed_descriptors(const std::string& what) { return malformed("USB descriptors: " + what); }

// Takes the first descriptor off `rest`. Every descriptor begins with its own length and type, so a length
// below two would stand still and one past the end would read somebody else's memory.
Result<ByteView> take_descriptor(ByteView& rest) {
    if (rest.size() < 2 || rest[0] < 2) {
        return malformed_descriptors("a descriptor is shorter than its header");
    }
    if (rest[0] > rest.size()) { return malformed_descriptors("a descriptor runs past the end"); }
    const ByteView descriptor = rest.first(rest[0]);
    rest = rest.subspan(rest[0]);
    return descriptor;
}

bool is_bulk_packet_size(std::uint16_t size_bytes) {  // USB 2.0 section 5.8.3
    return size_bytes == 8 || size_bytes == 16 || size_bytes == 32 || size_bytes == 64 || size_bytes == 512;
}

// What the walk over a configuration has seen so far.
struct Walk {
    std::optional<std::uint8_t> control_interface;
    std::optional<std::uint8_t> data_interface_by_union;
    bool in_control_interface = false;
    bool in_data_interface = false;
    bool data_interface_complete = false;
    CdcLayout layout;
};

void begin_interface(Walk& walk, ByteView interface) {
    const std::uint8_t number = interface[2];
    const std::uint8_t alternate = interface[3];
    const std::uint8_t interface_class = interface[5];
    const std::uint8_t subclass = interface[6];
    walk.in_control_interface = false;
    walk.data_interface_complete = walk.layout.endpoint_in != 0 && walk.layout.endpoint_out != 0;
    walk.in_data_interface = false;
    // Only the settings that are in force without a SET_INTERFACE.
    if (alternate != 0) { return; }
    if (interface_class == class_communications && subclass == subclass_abstract_control_model &&
        !walk.control_interface) {
        walk.control_interface = number;
        walk.in_control_interface = true;
    } else if (interface_class == class_data && walk.control_interface && !walk.data_interface_complete &&
               number == walk.data_interface_by_union.value_or(number)) {
        walk.layout.data_interface = number;
        walk.layout.endpoint_in = 0;
        walk.layout.endpoint_out = 0;
        walk.in_data_interface = true;
    }
}

Status take_endpoint(Walk& walk, ByteView endpoint) {
    if (!walk.in_data_interface || (endpoint[3] & transfer_type_mask) != transfer_type_bulk) { return {}; }
    const std::uint8_t address = endpoint[2];
    const auto packet_bytes = static_cast<std::uint16_t>(load_u16(endpoint, 4) & packet_bytes_mask);
    if (!is_bulk_packet_size(packet_bytes)) {
        return malformed_descriptors("a bulk endpoint has packets of " + std::to_string(packet_bytes) +
                                     " bytes");
    }
    const bool in = (address & endpoint_direction_in) != 0;
    std::uint8_t& place = in ? walk.layout.endpoint_in : walk.layout.endpoint_out;
    if (place != 0) { return {}; }
    if ((address & 0x0FU) == 0) { return malformed_descriptors("a bulk endpoint has the number 0"); }
    place = address;
    (in ? walk.layout.packet_in_bytes : walk.layout.packet_out_bytes) = packet_bytes;
    return {};
}

Status take(Walk& walk, ByteView descriptor) {
    switch (descriptor[1]) {
        case type_interface:
            if (descriptor.size() < interface_bytes_min) {
                return malformed_descriptors("an interface is too short");
            }
            begin_interface(walk, descriptor);
            return {};
        case type_endpoint:
            if (descriptor.size() < endpoint_bytes_min) {
                return malformed_descriptors("an endpoint is too short");
            }
            return take_endpoint(walk, descriptor);
        case type_class_specific_interface:
            if (walk.in_control_interface && descriptor.size() >= union_bytes_min &&
                descriptor[2] == subtype_union) {
                walk.data_interface_by_union = descriptor[4];
            }
            return {};
        default:
            return {};
    }
}

}  // namespace

Result<ByteView> find_configuration(ByteView descriptors, std::uint8_t configuration) {
    if (descriptors.size() < device_descriptor_bytes) {
        return malformed_descriptors("no device descriptor");
    }
    ByteView rest = descriptors.subspan(device_descriptor_bytes);
    while (!rest.empty()) {
        if (rest.size() < configuration_bytes_min) {
            return malformed_descriptors("a configuration is too short");
        }
        const std::size_t total_bytes = load_u16(rest, 2);
        if (rest[1] != type_configuration || total_bytes < configuration_bytes_min ||
            total_bytes > rest.size()) {
            return malformed_descriptors("a configuration's length is wrong");
        }
        if (rest[5] == configuration) { return rest.first(total_bytes); }
        rest = rest.subspan(total_bytes);
    }
    return Error{ErrorCode::not_found, "USB descriptors: no configuration " + std::to_string(configuration)};
}

Result<CdcLayout> parse_cdc_configuration(ByteView configuration) {
    if (configuration.size() < configuration_bytes_min || configuration[1] != type_configuration ||
        configuration[0] < configuration_bytes_min) {
        return malformed_descriptors("no configuration descriptor");
    }
    const std::size_t total_bytes = load_u16(configuration, 2);
    if (total_bytes > configuration.size()) {
        return malformed_descriptors("the configuration is cut short");
    }

    Walk walk;
    walk.layout.configuration = configuration[5];
    ByteView rest = configuration.first(total_bytes);
    while (!rest.empty()) {
        GYROLOG_TRY(const ByteView descriptor, take_descriptor(rest));
        GYROLOG_CHECK(take(walk, descriptor));
    }
    if (!walk.control_interface) {
        return Error{ErrorCode::unsupported, "no CDC-ACM interface among the USB descriptors"};
    }
    if (walk.layout.endpoint_in == 0 || walk.layout.endpoint_out == 0) {
        return Error{ErrorCode::unsupported, "the CDC data interface lacks a bulk IN or a bulk OUT endpoint"};
    }
    walk.layout.control_interface = *walk.control_interface;
    return walk.layout;
}

}  // namespace gyrolog
