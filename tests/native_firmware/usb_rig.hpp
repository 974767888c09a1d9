// A native board on a bus with its host, and what a test does with them: enumerate, open the port, command,
// read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gyrolog_protocol/frame.h>
#include <gyrolog_protocol/frame_stream.h>
#include <gyrolog_protocol/message.h>

#include "host/base/bytes.hpp"
#include "tests/native_firmware/native_board.hpp"
#include "tests/native_firmware/usb_host.hpp"

namespace gyrolog {

constexpr std::uint8_t data_in = 0x82;
constexpr std::uint8_t data_out = 0x02;
constexpr std::uint8_t notification_in = 0x81;

// A frame as it came, whole.
struct ArrivedFrame {
    std::uint8_t type = 0;
    std::uint16_t flags = 0;
    std::uint32_t sequence = 0;
    Bytes payload;

    glp_frame as_frame() const;
};

class UsbRig {
public:
    explicit UsbRig(const NativeBoardOptions& options = {});

    NativeBoard& board() { return board_; }
    UsbHost& host() { return host_; }
    void run_s(double duration_s);

    // Until the transfer has ended; -ETIMEDOUT after a second.
    UsbTransferEnd transfer(UsbTransfer transfer);
    UsbTransferEnd control(const UsbSetup& setup, Bytes out_data = {});
    Bytes descriptor(std::uint8_t kind, std::uint8_t index = 0);
    std::string text(std::uint8_t index);

    // Cable in, bus reset, address, configuration. False where the board does not take part.
    bool enumerate();
    // From the bus reset on.
    bool enumerate_again();
    bool set_dtr(bool on);
    void command(std::uint8_t type, ByteView payload);
    // Of all that a CONFIGURE can say, rate and layout; a filter that lets the rate through.
    void configure(std::uint32_t rate_hz, std::uint8_t layout);

    // The host keeps transfers posted from here on, or takes them back.
    void read(bool on);
    // What has arrived since the last call.
    std::vector<ArrivedFrame> take_frames();
    // Bytes that were in no intact frame, and are in none that may still become one.
    std::uint64_t damaged_bytes() const { return stream_.bytes_skipped; }

private:
    void post();
    void collect();

    NativeBoard board_;
    UsbHost host_;
    std::uint32_t next_id_ = 1;
    std::uint32_t command_sequence_ = 0;
    bool reading_ = false;
    std::vector<std::uint32_t> posted_;
    std::vector<UsbTransferEnd> others_;  // ended, not yet asked for
    std::vector<ArrivedFrame> frames_;
    glp_stream stream_{};
};

}  // namespace gyrolog
