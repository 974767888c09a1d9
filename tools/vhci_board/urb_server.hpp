// The board behind a host controller: takes URBs from the kernel, answers them with what the board does. No
// socket and no clock of its own, so that a test can drive it.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "host/base/bytes.hpp"
#include "host/virtual_board/usb_function.hpp"
#include "tools/vhci_board/link_fault.hpp"
#include "tools/vhci_board/usbip.hpp"

namespace gyrolog {

// A transfer that the host gives up, or that meets a fault of the wire, carries no data: the board has sent
// nothing that was acknowledged, and sends it into the next one.
class UrbServer {
public:
    // `function` must outlive the server.
    UrbServer(UsbFunction& function, std::vector<LinkFault> faults);

    void carry_out(const usbip::Command& command);
    // Completes the transfers that wait for the board, as far as it has something for them. `streaming_s`:
    // time since the board first began to stream.
    void serve(double streaming_s);
    // The replies made since the last call, for the kernel.
    Bytes take_replies();

private:
    struct Waiting {
        std::uint32_t sequence;
        std::uint32_t requested_bytes;
    };

    void control(const usbip::Submit& submit);
    void give_up(const usbip::Unlink& unlink);
    bool fail_by_fault(double streaming_s);
    void complete_front(int status, ByteView data);

    UsbFunction& function_;
    std::vector<LinkFault> faults_;      // not yet met, in the order of time
    bool halted_ = false;                // the bulk IN endpoint, after a stall
    std::deque<Waiting> bulk_in_;        // in the order of submission
    std::deque<Waiting> notifications_;  // interrupt IN: the board never sends one
    Bytes buffer_;
    Bytes replies_;
};

}  // namespace gyrolog
