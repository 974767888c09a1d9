// An open board whose two CDC interfaces are ours.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "host/base/result.hpp"
#include "host/usb/bulk_in_stream.hpp"
#include "host/usb/usb_board.hpp"
#include "host/usb/usb_context.hpp"

struct libusb_device_handle;

namespace gyrolog {

// The context must outlive this object; every BulkInStream on handle() must be gone before it.
class UsbDevice {
public:
    // Opens the board and takes both interfaces away from a kernel driver that has them.
    static Result<std::unique_ptr<UsbDevice>> open(UsbContext& usb, const UsbBoard& board);
    UsbDevice(const UsbDevice&) = delete;
    UsbDevice& operator=(const UsbDevice&) = delete;
    // Gives the interfaces back, so that /dev/ttyACM* is there again, and closes.
    ~UsbDevice();

    libusb_device_handle* handle() const { return handle_; }
    const UsbBoard& board() const { return board_; }

    // SET_CONTROL_LINE_STATE (USB CDC PSTN 1.2 section 6.3.12). `unsupported` when the board refuses the
    // request.
    Status set_line_state(bool data_terminal_ready, TransferObserver& observer);
    // Sends all of it over the bulk OUT endpoint within the time, or says that it could not.
    Status write(ByteView bytes, std::int64_t timeout_ms, TransferObserver& observer);

private:
    UsbDevice(UsbContext& usb, libusb_device_handle* handle, UsbBoard board);
    Status claim(std::uint8_t interface);

    UsbContext& usb_;
    libusb_device_handle* handle_;
    UsbBoard board_;
    std::vector<std::uint8_t> claimed_;
};

}  // namespace gyrolog
