#include "host/virtual_board/breached_source.hpp"

#include <algorithm>
#include <utility>

#include <gyrolog_protocol/message.h>
#include <gyrolog_protocol/usb_identity.h>

namespace gyrolog {

void BreachedLine::send(RawFrame frame, std::uint32_t checksum_error) {
    frame.sequence = next_number_++;
    send_bytes(frame.wire(checksum_error));
}

const Breach* breach_named(std::string_view name) {
    const auto all = breaches();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Breach& one) { return one.name == name; });
    return found == all.end() ? nullptr : &*found;
}

BreachedSource::BreachedSource(std::unique_ptr<ByteSource> board, const Breach& breach)
    : board_(std::move(board)), breach_(breach), identity_(board_->identity()) {
    glp_stream_init(&frames_);
    if (breach_.on_identity != nullptr) { breach_.on_identity(identity_); }
}

Status BreachedSource::start(TransferSink& sink) {
    sink_ = &sink;
    return board_->start(*this);
}

Status BreachedSource::set_line_state(bool data_terminal_ready) {
    return board_->set_line_state(data_terminal_ready);
}

Status BreachedSource::write(ByteView bytes) {
    Bytes tampered(bytes.begin(), bytes.end());
    if (breach_.on_write != nullptr) {
        const std::lock_guard lock(mutex_);
        tampered = breach_.on_write(line_, bytes);
    }
    return tampered.empty() ? Status() : board_->write(tampered);
}

void BreachedSource::take_frame(const glp_frame& frame) {
    if (!std::exchange(line_.numbered_, true)) { line_.next_number_ = frame.sequence; }
    RawFrame raw{.type = frame.type,
                 .flags = frame.flags,
                 .sequence = frame.sequence,
                 .payload = Bytes(frame.payload, frame.payload + frame.payload_bytes)};
    glp_event event{};
    if (frame.type == glp_frame_event && glp_event_read(&frame, &event) == glp_status_ok) {
        if (event.code == glp_event_started) { line_.streaming = true; }
        if (event.code == glp_event_stopped) { line_.streaming = false; }
    }
    if (breach_.on_frame != nullptr) {
        breach_.on_frame(line_, raw);
    } else {
        line_.send(std::move(raw));
    }
}

void BreachedSource::tamper(ByteView bytes) {
    while (!bytes.empty()) {
        glp_frame frame{};
        bool have_frame = false;
        bytes = bytes.subspan(glp_stream_push(&frames_, bytes.data(), bytes.size(), &frame, &have_frame));
        if (have_frame) { take_frame(frame); }
    }
}

bool BreachedSource::hand_on(Transfer transfer) {
    transfer.data = *waiting_;
    if (!sink_->on_transfer(transfer)) { return false; }
    waiting_.reset();
    return true;
}

bool BreachedSource::on_transfer(const Transfer& transfer) {
    if (transfer.carries_stream()) {
        if (!waiting_) {
            const std::lock_guard lock(mutex_);
            tamper(transfer.data);
            waiting_ = std::exchange(line_.out_, {});
        }
        return hand_on(transfer);
    }
    const bool line = transfer.kind == TransferKind::control &&
                      transfer.event == Transfer::Event::submission &&
                      transfer.setup[1] == GLP_CDC_SET_CONTROL_LINE_STATE;
    if (line) {
        const std::lock_guard lock(mutex_);
        line_.raised = (transfer.setup[2] & GLP_CDC_LINE_DTR) != 0;
        line_.just_raised = line_.raised;
    }
    return sink_->on_transfer(transfer);
}

void BreachedSource::on_end(SourceEnd end, const std::optional<Error>& error) { sink_->on_end(end, error); }

}  // namespace gyrolog
