// Which boards are on the bus, and what stands in the way of using one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/result.hpp"
#include "host/usb/cdc_descriptors.hpp"
#include "host/usb/usb_context.hpp"

namespace gyrolog {

enum class BoardState {
    ready,
    no_permission,   // `why` holds the mend
    busy,            // another program has claimed it
    wrong_protocol,  // no board, or no board's descriptors
};

// "ready", "no_permission", "busy", "wrong_protocol": as `gyrolog list --json` spells them.
std::string_view board_state_name(BoardState state);

struct UsbBoard {
    std::uint8_t bus_number = 0;
    std::uint8_t device_address = 0;
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::string manufacturer;
    std::string product;
    std::string serial;
    Bytes device_descriptor;
    Bytes configuration_descriptor;
    CdcLayout layout;  // meaningless when wrong_protocol

    BoardState state = BoardState::ready;
    std::string why;  // empty when ready

    std::string uri() const;  // "usb:SERIAL", or "usb:" for a board without a serial number
};

// A board is known by its id and by a product string that begins with GLP_USB_PRODUCT_PREFIX: by both.
struct UsbSurvey {
    std::vector<UsbBoard> boards;
    // Somebody else's that have one of the two. They are wrong_protocol, `why` says which is missing, and
    // nothing but the kernel's files about them is ever opened.
    std::vector<UsbBoard> strangers;
    std::vector<std::string> others;  // what else is there, hubs left out: "046d:c52b Logitech USB Receiver"
};

// Boards are opened for a moment to see whether that is allowed; a kernel driver that is bound stays bound.
Result<UsbSurvey> survey_usb(UsbContext& usb);

// The ready board with this serial number; with an empty serial the only board there is. Otherwise the error
// says what to do: `not_found` (with what was found instead), `permission_denied`, `busy`, `unsupported`, or
// `invalid_argument` when several boards fit.
Result<UsbBoard> choose_board(const UsbSurvey& survey, std::string_view serial);

}  // namespace gyrolog
