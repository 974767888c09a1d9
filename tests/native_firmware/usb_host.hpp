// The computer's host controller: carries transfers out as transactions on a full-speed bus, in the part's
// time.
//
// Modelled: a start of frame each millisecond, one transaction after another with the time that it takes on
// the wire, retries after NAK, data toggles, stages of a control transfer, short and overlong packets,
// stalls, no answer. Left out: signalling, isochronous transfers, a frame's bandwidth beyond what the wire
// itself allows.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "host/base/bytes.hpp"
#include "tests/native_firmware/processor.hpp"
#include "tests/native_firmware/usb_device.hpp"

namespace gyrolog {

// As the kernel submits it: on endpoint 0 with a setup packet.
struct UsbTransfer {
    std::uint32_t id = 0;
    std::uint8_t endpoint = 0;  // with 0x80 for IN
    UsbSetup setup{};
    Bytes out_data;
    std::size_t in_bytes = 0;  // at most
};

struct UsbTransferEnd {
    std::uint32_t id = 0;
    int status = 0;  // 0 or a negative errno, as the kernel reports it
    Bytes in_data;
    std::size_t out_bytes = 0;
};

struct UsbHostAccounts {
    std::uint64_t frames = 0;
    std::uint64_t packets = 0;
    std::uint64_t naks = 0;
    std::uint64_t repeated = 0;  // IN packets whose toggle is that of the one before: thrown away
};

class UsbHost final : public Surroundings {
public:
    // `notification`: the interrupt endpoint, asked seldom.
    UsbHost(Processor& processor, UsbDevice& device, std::uint8_t notification);

    // Cable in or out. Out, everything that waits fails.
    void plug(bool in);
    // Everything that waits fails; address and toggles begin anew. The reset takes reset_ms.
    void reset();
    void suspend(bool on);
    void submit(UsbTransfer transfer);
    // False when it has ended already, or ends now with the packets that had come.
    bool give_up(std::uint32_t id);
    std::vector<UsbTransferEnd> take_ended() { return std::exchange(ended_, {}); }
    // The device's address after reset() is 0; a SET_ADDRESS that passes changes it.
    unsigned address() const { return address_; }
    // The handshakes of the host for the next so many IN packets get lost.
    void lose_handshakes(unsigned count) { handshakes_to_lose_ = count; }
    const UsbHostAccounts& accounts() const { return accounts_; }

    std::uint64_t next_event_ticks() const override;
    void pass_event(std::uint64_t now_ticks) override;

private:
    enum class Stage { setup, data, status };

    struct Pipe {
        std::deque<UsbTransfer> waiting;
        Bytes in_data;  // of the front one
        std::size_t out_bytes = 0;
        Stage stage = Stage::setup;
        unsigned toggle = 0;
        unsigned failures = 0;
        std::uint64_t retry_ticks = 0;
    };

    std::uint64_t us(std::uint64_t duration_us) const { return duration_us * processor_.ticks_per_us(); }
    bool may_serve(std::uint8_t endpoint, const Pipe& pipe) const;
    void fail_all(int status);
    void end_front(Pipe& pipe, int status);
    void spend(std::size_t packet_bytes);
    bool answered(std::uint8_t endpoint, Pipe& pipe, Handshake handshake);
    void transact(std::uint8_t endpoint, Pipe& pipe);
    void control(Pipe& pipe);
    void control_done(Pipe& pipe);
    bool in_packet(std::uint8_t endpoint, Pipe& pipe, UsbPacket& packet);
    void in(std::uint8_t endpoint, Pipe& pipe);
    bool out_packet(std::uint8_t endpoint, Pipe& pipe);
    void out(std::uint8_t endpoint, Pipe& pipe);

    Processor& processor_;
    UsbDevice& device_;
    std::uint8_t notification_;
    std::map<std::uint8_t, Pipe> pipes_;
    std::uint8_t last_served_ = 0;
    std::vector<UsbTransferEnd> ended_;
    UsbHostAccounts accounts_;
    unsigned address_ = 0;
    bool configured_ = false;
    unsigned handshakes_to_lose_ = 0;
    std::uint64_t frame_ticks_ = never_ticks;  // of the next start of frame; never while the bus idles
    std::uint64_t free_ticks_ = 0;             // when the wire is free
};

}  // namespace gyrolog
