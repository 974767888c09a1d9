#include "host/virtual_board/usb_function.hpp"

#include <algorithm>

#include <gyrolog_protocol/usb_identity.h>

#include "host/virtual_board/usb_descriptors.hpp"

namespace gyrolog {

namespace {

// bmRequestType (USB 2.0, table 9-2)
constexpr std::uint8_t direction_in = 0x80;
constexpr std::uint8_t kind_mask = 0x60;
constexpr std::uint8_t kind_standard = 0x00;
constexpr std::uint8_t kind_class = 0x20;

// bRequest (USB 2.0, table 9-4)
enum Request : std::uint8_t {
    get_status = 0,
    clear_feature = 1,
    set_feature = 3,
    set_address = 5,
    get_descriptor = 6,
    get_configuration = 8,
    set_configuration = 9,
    get_interface = 10,
    set_interface = 11,
};
enum AskedDescriptor : std::uint8_t { device = 1, configuration = 2, string = 3 };

constexpr std::uint8_t only_configuration = 1;
// The endpoint's own: two packets (double buffering).
constexpr std::size_t control_bytes = std::size_t{2} * GLP_USB_PACKET_BYTES;

unsigned setup_field(const std::array<std::uint8_t, 8>& setup, std::size_t at) {
    return setup[at] | static_cast<unsigned>(setup[at + 1]) << 8U;
}

const UsbFunction::ControlResponse stalled = {true, {}};

}  // namespace

UsbFunction::UsbFunction(VirtualBoard& board) : board_(board) {
    board_.in_endpoint().set_capacity(control_bytes);
}

void UsbFunction::advance_to(std::int64_t host_monotonic_ns) {
    if (!origin_ns_) { origin_ns_ = host_monotonic_ns - board_.now_ns(); }
    board_.advance_to(host_monotonic_ns - *origin_ns_);
}

UsbFunction::ControlResponse UsbFunction::control(const std::array<std::uint8_t, 8>& setup,
                                                  ByteView out_data) {
    ControlResponse response = stalled;
    if ((setup[0] & kind_mask) == kind_standard) { response = standard_request(setup); }
    if ((setup[0] & kind_mask) == kind_class) { response = class_request(setup, out_data); }
    const std::size_t asked = (setup[0] & direction_in) != 0 ? setup_field(setup, 6) : 0;
    if (response.data.size() > asked) { response.data.resize(asked); }
    return response;
}

UsbFunction::ControlResponse UsbFunction::standard_request(const std::array<std::uint8_t, 8>& setup) {
    switch (setup[1]) {
        case get_descriptor:
            if (setup[3] == device) { return {false, device_descriptor()}; }
            if (setup[3] == configuration && setup[2] == 0) {
                return {false, configuration_descriptor(board_.endpoints())};
            }
            if (setup[3] == string) {
                if (auto text = string_descriptor(setup[2], board_.serial())) {
                    return {false, std::move(*text)};
                }
            }
            return stalled;
        case set_configuration:
            if (setup[2] > only_configuration) { return stalled; }
            if (setup[2] == 0) { bus_reset(); }
            configuration_ = setup[2];
            return {};
        case get_configuration:
            return {false, {configuration_}};
        case get_status:
            return {false, {0, 0}};
        case get_interface:
            return {false, {0}};
        case set_interface:
            return setup_field(setup, 2) == 0 ? ControlResponse{} : stalled;
        case clear_feature:
        case set_feature:
        case set_address:
            return {};
        default:
            return stalled;
    }
}

UsbFunction::ControlResponse UsbFunction::class_request(const std::array<std::uint8_t, 8>& setup,
                                                        ByteView out_data) {
    switch (setup[1]) {
        case GLP_CDC_SET_LINE_CODING:
            if (out_data.size() != line_coding_.size()) { return stalled; }
            std::copy(out_data.begin(), out_data.end(), line_coding_.begin());
            return {};
        case GLP_CDC_GET_LINE_CODING:
            return {false, Bytes(line_coding_.begin(), line_coding_.end())};
        case GLP_CDC_SET_CONTROL_LINE_STATE:
            board_.on_line_state((setup[2] & GLP_CDC_LINE_DTR) != 0);
            return {};
        default:
            return stalled;
    }
}

std::optional<std::size_t> UsbFunction::bulk_in(std::span<std::uint8_t> buffer) {
    board_.in_endpoint().set_capacity(buffer.size() + control_bytes);
    const auto size = board_.in_endpoint().take_transfer(buffer);
    if (size) { return size; }
    board_.advance_to(board_.now_ns());
    return board_.in_endpoint().take_transfer(buffer);
}

void UsbFunction::bulk_out(ByteView data) { board_.on_receive(data); }

void UsbFunction::bus_reset() {
    configuration_ = 0;
    board_.on_line_state(false);
    board_.in_endpoint().clear();
    board_.in_endpoint().set_capacity(control_bytes);
}

}  // namespace gyrolog
