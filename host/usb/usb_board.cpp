#include "host/usb/usb_board.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include <gyrolog_protocol/usb_identity.h>
#include <libusb.h>

#include "host/usb/sysfs.hpp"
#include "host/usb/usb_status.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t port_depth_max = 7;  // USB 2.0 section 4.1.1: seven tiers

struct DeviceListDeleter {
    void operator()(libusb_device** list) const { libusb_free_device_list(list, 1); }
};
using DeviceList = std::unique_ptr<libusb_device*[], DeviceListDeleter>;

// The kernel's directory of a device, "1-4.2": bus, then the port on each hub on the way. Empty for a root
// hub.
std::string sysfs_directory(libusb_device* device) {
    std::array<std::uint8_t, port_depth_max> ports{};
    const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
    if (depth <= 0) { return {}; }
    std::string directory = "/sys/bus/usb/devices/" + std::to_string(libusb_get_bus_number(device));
    for (int i = 0; i < depth; ++i) {
        directory += i == 0 ? '-' : '.';
        directory += std::to_string(ports[static_cast<std::size_t>(i)]);
    }
    return directory;
}

std::string id_text(unsigned vendor_id, unsigned product_id) {
    std::array<char, 10> text{};
    static_cast<void>(std::snprintf(text.data(), text.size(), "%04x:%04x", vendor_id, product_id));
    return text.data();
}

std::string describe(const UsbBoard& board) {
    std::string text = id_text(board.vendor_id, board.product_id);
    if (!board.manufacturer.empty()) { text += " " + board.manufacturer; }
    if (!board.product.empty()) { text += " " + board.product; }
    return text;
}

std::string own_id() { return id_text(GLP_USB_VENDOR_ID, GLP_USB_PRODUCT_ID); }
std::string former_id() { return id_text(GLP_USB_FORMER_VENDOR_ID, GLP_USB_FORMER_PRODUCT_ID); }

bool has_boards_id(const UsbBoard& device) {
    return glp_usb_id_of(device.vendor_id, device.product_id) != glp_usb_id_other;
}

bool has_boards_name(const UsbBoard& device) { return device.product.starts_with(GLP_USB_PRODUCT_PREFIX); }

UsbBoard identify(libusb_device* device, const libusb_device_descriptor& descriptor,
                  const std::string& directory) {
    UsbBoard board;
    board.bus_number = libusb_get_bus_number(device);
    board.device_address = libusb_get_device_address(device);
    board.vendor_id = descriptor.idVendor;
    board.product_id = descriptor.idProduct;
    board.manufacturer = read_sysfs_text(directory, "manufacturer");
    board.product = read_sysfs_text(directory, "product");
    board.serial = read_sysfs_text(directory, "serial");
    return board;
}

Status read_descriptors(UsbBoard& board, const std::string& directory) {
    GYROLOG_TRY(UsbDescriptors descriptors, read_usb_descriptors(directory));
    board.device_descriptor = std::move(descriptors.device);
    board.configuration_descriptor = std::move(descriptors.configuration);
    board.layout = descriptors.layout;
    return {};
}

void refuse(UsbBoard& board, BoardState state, std::string why) {
    board.state = state;
    board.why = std::move(why);
}

std::string why_a_stranger(const UsbBoard& device) {
    if (has_boards_name(device)) {
        return "not a board by its id, which is neither " + own_id() + " nor " + former_id() + ": left alone";
    }
    if (device.product.empty()) {
        return "not a board by its product name, which it does not tell: left alone";
    }
    return "not a board by its product name, '" + device.product +
           "', which does not begin with '" GLP_USB_PRODUCT_PREFIX "': left alone";
}

// Whether somebody holds the interface. One that a kernel driver holds is free for us: the driver can be
// detached.
bool is_claimed_elsewhere(libusb_device_handle* handle, std::uint8_t interface) {
    if (libusb_kernel_driver_active(handle, interface) == 1) { return false; }
    const int code = libusb_claim_interface(handle, interface);
    if (code == LIBUSB_SUCCESS) { libusb_release_interface(handle, interface); }
    return code == LIBUSB_ERROR_BUSY;
}

// False when the board went away meanwhile.
bool try_access(UsbBoard& board, libusb_device* device) {
    libusb_device_handle* handle = nullptr;
    const int code = libusb_open(device, &handle);
    if (code == LIBUSB_ERROR_NO_DEVICE) { return false; }
    if (code == LIBUSB_ERROR_ACCESS) {
        refuse(
            board, BoardState::no_permission,
            "no permission to open it; the udev rule 60-gyrolog.rules gives it (`gyrolog doctor` says how to "
            "install it); then plug the board in again; over ssh also join the group plugdev");
        return true;
    }
    if (code != LIBUSB_SUCCESS) {
        refuse(board, BoardState::busy, usb_error("open it", code).message);
        return true;
    }
    if (is_claimed_elsewhere(handle, board.layout.control_interface) ||
        is_claimed_elsewhere(handle, board.layout.data_interface)) {
        refuse(board, BoardState::busy, "another program is using it");
    }
    libusb_close(handle);
    return true;
}

void add_device(UsbSurvey& survey, libusb_device* device) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(device, &descriptor) != LIBUSB_SUCCESS) { return; }
    const std::string directory = sysfs_directory(device);
    if (directory.empty() || descriptor.bDeviceClass == LIBUSB_CLASS_HUB) { return; }
    UsbBoard board = identify(device, descriptor, directory);
    if (!has_boards_id(board) && !has_boards_name(board)) {
        survey.others.push_back(describe(board));
        return;
    }
    if (!has_boards_id(board) || !has_boards_name(board)) {
        refuse(board, BoardState::wrong_protocol, why_a_stranger(board));
        survey.strangers.push_back(std::move(board));
        return;
    }
    if (const Status readable = read_descriptors(board, directory); !readable.ok()) {
        refuse(board, BoardState::wrong_protocol, readable.error().message);
    } else if (!try_access(board, device)) {
        return;
    }
    survey.boards.push_back(std::move(board));
}

// How a board is known, as the user may compare it with lsusb.
std::string board_marks() {
    return own_id() + ", or formerly " + former_id() +
           ", with a product name that begins with '" GLP_USB_PRODUCT_PREFIX "'";
}

std::string list_of(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) { text += (text.empty() ? "" : ", ") + name; }
    return text.empty() ? "nothing" : text;
}

ErrorCode error_code_of(BoardState state) {
    switch (state) {
        case BoardState::no_permission:
            return ErrorCode::permission_denied;
        case BoardState::busy:
            return ErrorCode::busy;
        default:
            return ErrorCode::unsupported;
    }
}

}  // namespace

std::string_view board_state_name(BoardState state) {
    switch (state) {
        case BoardState::ready:
            return "ready";
        case BoardState::no_permission:
            return "no_permission";
        case BoardState::busy:
            return "busy";
        case BoardState::wrong_protocol:
            return "wrong_protocol";
    }
    return "";
}

std::string UsbBoard::uri() const { return "usb:" + serial; }

Result<UsbSurvey> survey_usb(UsbContext& usb) {
    libusb_device** raw = nullptr;
    const ssize_t count = libusb_get_device_list(usb.get(), &raw);
    if (count < 0) { return usb_error("list the USB devices", static_cast<int>(count)); }
    const DeviceList list(raw);
    UsbSurvey survey;
    for (ssize_t i = 0; i < count; ++i) { add_device(survey, list[static_cast<std::size_t>(i)]); }
    for (auto* devices : {&survey.boards, &survey.strangers}) {
        std::ranges::sort(*devices, {}, &UsbBoard::serial);
    }
    return survey;
}

Result<UsbBoard> choose_board(const UsbSurvey& survey, std::string_view serial) {
    std::vector<const UsbBoard*> fitting;
    std::vector<std::string> uris;
    for (const UsbBoard& board : survey.boards) {
        uris.push_back(board.uri());
        if (serial.empty() || board.serial == serial) { fitting.push_back(&board); }
    }
    if (fitting.empty()) {
        std::vector<std::string> instead = uris;
        for (const UsbBoard& stranger : survey.strangers) {
            instead.push_back(describe(stranger) + " (" + stranger.why + ")");
        }
        instead.insert(instead.end(), survey.others.begin(), survey.others.end());
        const std::string wanted =
            serial.empty() ? std::string("no board") : "no board 'usb:" + std::string(serial) + "'";
        return Error{ErrorCode::not_found,
                     wanted + " on USB: looked for " + board_marks() + ", found " + list_of(instead)};
    }
    if (fitting.size() > 1) {
        return Error{ErrorCode::invalid_argument, "find a board: several fit, name one of " + list_of(uris)};
    }
    const UsbBoard& board = *fitting.front();
    if (board.state != BoardState::ready) {
        return Error{error_code_of(board.state), "open board '" + board.uri() + "': " + board.why};
    }
    return board;
}

}  // namespace gyrolog
