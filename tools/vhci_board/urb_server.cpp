#include "tools/vhci_board/urb_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include <gyrolog_protocol/usb_identity.h>

namespace gyrolog {
namespace {

constexpr std::uint8_t direction_in = 0x80;

// CLEAR_FEATURE(ENDPOINT_HALT) (USB 2.0, 9.4.1).
bool clears_halt(const std::array<std::uint8_t, 8>& setup, std::uint8_t endpoint) {
    return setup[0] == 0x02 && setup[1] == 0x01 && setup[2] == 0 && setup[4] == endpoint;
}

}  // namespace

UrbServer::UrbServer(UsbFunction& function, std::vector<LinkFault> faults)
    : function_(function), faults_(std::move(faults)) {
    std::stable_sort(faults_.begin(), faults_.end(),
                     [](const LinkFault& a, const LinkFault& b) { return a.at_s < b.at_s; });
}

void UrbServer::carry_out(const usbip::Command& command) {
    if (const auto* unlink = std::get_if<usbip::Unlink>(&command)) {
        give_up(*unlink);
        return;
    }
    const auto& submit = std::get<usbip::Submit>(command);
    const UsbEndpoints& board = function_.endpoints();
    const std::uint32_t address = submit.endpoint | (submit.in ? direction_in : 0U);
    if (submit.endpoint == 0) {
        control(submit);
    } else if (address == board.in) {
        bulk_in_.push_back({submit.sequence, submit.requested_bytes});
    } else if (address == board.out) {
        function_.bulk_out(submit.data);
        usbip::append_submit_reply(replies_, submit.sequence, 0, submit.requested_bytes, {});
    } else {
        notifications_.push_back({submit.sequence, submit.requested_bytes});
    }
}

void UrbServer::control(const usbip::Submit& submit) {
    if (clears_halt(submit.setup, function_.endpoints().in)) { halted_ = false; }
    const UsbFunction::ControlResponse response = function_.control(submit.setup, submit.data);
    if (response.stall) {
        usbip::append_submit_reply(replies_, submit.sequence, -EPIPE, 0, {});
        return;
    }
    if (!submit.in) {
        usbip::append_submit_reply(replies_, submit.sequence, 0, submit.requested_bytes, {});
        return;
    }
    const auto bytes = std::min<std::size_t>(response.data.size(), submit.requested_bytes);
    usbip::append_submit_reply(replies_, submit.sequence, 0, static_cast<std::uint32_t>(bytes),
                               ByteView(response.data).first(bytes));
}

void UrbServer::give_up(const usbip::Unlink& unlink) {
    for (auto* queue : {&bulk_in_, &notifications_}) {
        const auto found = std::find_if(queue->begin(), queue->end(), [&](const Waiting& waiting) {
            return waiting.sequence == unlink.target;
        });
        if (found == queue->end()) { continue; }
        queue->erase(found);
        usbip::append_unlink_reply(replies_, unlink.sequence, -ECONNRESET);
        return;
    }
    usbip::append_unlink_reply(replies_, unlink.sequence, 0);
}

bool UrbServer::fail_by_fault(double streaming_s) {
    if (halted_) {
        complete_front(-EPIPE, {});
        return true;
    }
    if (faults_.empty() || streaming_s < faults_.front().at_s) { return false; }
    const LinkFaultKind kind = faults_.front().kind;
    faults_.erase(faults_.begin());
    halted_ = kind == LinkFaultKind::stall;
    complete_front(link_fault_status(kind), {});
    return true;
}

void UrbServer::complete_front(int status, ByteView data) {
    usbip::append_submit_reply(replies_, bulk_in_.front().sequence, status,
                               static_cast<std::uint32_t>(data.size()), data);
    bulk_in_.pop_front();
}

void UrbServer::serve(double streaming_s) {
    while (!bulk_in_.empty()) {
        if (fail_by_fault(streaming_s)) { continue; }
        const std::uint32_t requested_bytes = bulk_in_.front().requested_bytes;
        // The board's packet may be longer than what is left of such a transfer: the host's own mistake.
        if (requested_bytes % GLP_USB_PACKET_BYTES != 0) {
            complete_front(-EOVERFLOW, {});
            continue;
        }
        buffer_.resize(requested_bytes);
        const auto received_bytes = function_.bulk_in(buffer_);
        if (!received_bytes) { return; }
        complete_front(0, ByteView(buffer_).first(*received_bytes));
    }
}

Bytes UrbServer::take_replies() { return std::exchange(replies_, {}); }

}  // namespace gyrolog
