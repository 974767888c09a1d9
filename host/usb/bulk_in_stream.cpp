#include "host/usb/bulk_in_stream.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <utility>

#include <libusb.h>

#include "host/usb/usb_status.hpp"

namespace gyrolog {
namespace {

constexpr std::uint32_t short_transfer_bytes = 512;
constexpr std::uint32_t short_transfers_min = 32;
constexpr std::uint32_t short_transfers_max = 2048;
constexpr double stall_of_unknown_stream_s = 2.0;
constexpr std::uint32_t long_frame_transfer_bytes = 1024;  // holds the longest frame
constexpr std::uint32_t full_transfer_bytes = 16384;
constexpr double bytes_queued_max = 4194304.0;
// USB 2.0 section 5.8.4: 19 packets of 64 bytes a millisecond. A board that needs nearly all of them sends
// none that is short.
constexpr double saturated_bytes_per_s = 0.9 * 1'216'000.0;

// A full-speed bus can carry 19 packets a millisecond; a board that flushes on a timer sends one at the most.
constexpr unsigned empty_limit = 1000;
constexpr std::int64_t empty_limit_window_ns = 100'000'000;

constexpr unsigned errors_in_row_min = 8;

}  // namespace

BulkInPlan BulkInPlan::for_short_packets(double completions_per_s) {
    const double wanted = std::ceil(stall_of_unknown_stream_s * completions_per_s);
    const double bounded = std::clamp(wanted, double{short_transfers_min}, double{short_transfers_max});
    return {static_cast<std::uint32_t>(bounded), short_transfer_bytes};
}

BulkInPlan BulkInPlan::for_stream(double bytes_per_s, double bytes_per_frame, double stall_s) {
    const bool full = bytes_per_s >= saturated_bytes_per_s;
    const std::uint32_t size = full                                     ? full_transfer_bytes
                               : bytes_per_frame > short_transfer_bytes ? long_frame_transfer_bytes
                                                                        : short_transfer_bytes;
    const double size_bytes = size;
    const double filled_bytes = full ? size_bytes : std::clamp(bytes_per_frame, 1.0, size_bytes);
    const double wanted = std::ceil(stall_s * bytes_per_s / filled_bytes);
    return {static_cast<std::uint32_t>(
                std::clamp(wanted, double{short_transfers_min}, bytes_queued_max / size_bytes)),
            size};
}

BulkInStream::BulkInStream(UsbContext& usb, libusb_device_handle* device, std::uint8_t endpoint,
                           BulkInPlan plan, TransferObserver& observer)
    : usb_(usb), device_(device), endpoint_(endpoint), plan_(plan), observer_(observer) {}

BulkInStream::~BulkInStream() {
    stop();
    for (const Slot& slot : slots_) { libusb_free_transfer(slot.transfer); }
}

// All memory is taken here, so that no callback allocates. What is there stays where it is.
Status BulkInStream::allocate(BulkInPlan plan) {
    std::vector<std::uint8_t>& buffer =
        buffers_.emplace_back(std::size_t{plan.transfers} * plan.transfer_bytes);
    const auto callback = [](libusb_transfer* transfer) {
        auto* slot = static_cast<Slot*>(transfer->user_data);
        slot->stream->on_complete(*slot);
    };
    for (std::uint32_t i = 0; i < plan.transfers; ++i) {
        libusb_transfer* transfer = libusb_alloc_transfer(0);
        if (transfer == nullptr) { return usb_error("prepare the bulk stream", LIBUSB_ERROR_NO_MEM); }
        std::uint8_t* data = buffer.data() + std::size_t{i} * plan.transfer_bytes;
        slots_.push_back({.stream = this, .transfer = transfer, .bytes = plan.transfer_bytes});
        libusb_fill_bulk_transfer(transfer, device_, endpoint_, data, static_cast<int>(plan.transfer_bytes),
                                  callback, &slots_.back(), 0);
    }
    return {};
}

Status BulkInStream::start(EndHandler on_end) {
    if (slots_.empty()) { GYROLOG_CHECK(allocate(plan_)); }
    bool queued = false;
    int code = LIBUSB_SUCCESS;
    std::optional<Error> failure;
    usb_.call([&] {
        failure = usb_.failure();
        if (failure) { return; }
        errors_in_row_ = stalls_in_row_ = empty_in_row_ = 0;
        error_.reset();
        code = submit_all();
        queued = in_flight_ > 0;
        if (!queued) { return; }
        on_end_ = std::move(on_end);
        state_ = State::running;
        usb_.add(*this);
        const std::lock_guard lock(mutex_);
        ended_ = false;
    });
    if (failure) { return *failure; }
    if (!queued) { return usb_error("queue the first bulk transfer", code); }
    return {};
}

void BulkInStream::deepen(BulkInPlan plan) {
    usb_.call([&] {
        if (state_ != State::running) { return; }
        const std::size_t before = slots_.size();
        if (!allocate(plan).ok() || submit_all() != LIBUSB_SUCCESS) { return; }
        for (std::size_t i = 0; i < before; ++i) { slots_[i].retired = true; }
    });
}

double BulkInStream::capacity_bytes(double bytes_per_frame) const {
    const auto filled = [&](std::uint32_t transfer_bytes) {
        return bytes_per_frame / std::max(1.0, std::ceil(bytes_per_frame / transfer_bytes));
    };
    double capacity = 0.0;
    usb_.call([&] {
        if (state_ == State::idle) { capacity = plan_.transfers * filled(plan_.transfer_bytes); }
        for (const Slot& slot : slots_) {
            if (slot.in_flight && !slot.retired) { capacity += filled(slot.bytes); }
        }
    });
    return capacity;
}

void BulkInStream::stop() {
    usb_.call([this] {
        if (state_ == State::running || state_ == State::clearing_halt) {
            begin_end(End::stopped, std::nullopt);
        }
    });
    std::unique_lock lock(mutex_);
    ended_changed_.wait(lock, [this] { return ended_; });
}

bool BulkInStream::wait_for_end(std::int64_t timeout_ms) {
    std::unique_lock lock(mutex_);
    return ended_changed_.wait_for(lock, std::chrono::milliseconds(timeout_ms), [this] { return ended_; });
}

// A refused submission is told to nobody: the kernel never had the transfer.
int BulkInStream::submit(Slot& slot) {
    Transfer told;
    told.event = Transfer::Event::submission;
    told.endpoint = endpoint_;
    told.requested_bytes = slot.bytes;
    told.time = host_now();
    const int code = libusb_submit_transfer(slot.transfer);
    if (code != LIBUSB_SUCCESS) { return code; }
    slot.in_flight = true;
    ++in_flight_;
    // Its completion is handled by this thread, hence later, however early the data come.
    slot.id = told.id = usb_.next_transfer_id();
    observer_.on_usb_transfer(told);
    return code;
}

// Stops at the first refusal: the kernel is out of memory, or the device is gone. Returns its code.
int BulkInStream::submit_all() {
    for (Slot& slot : slots_) {
        if (slot.in_flight || slot.retired) { continue; }
        if (const int code = submit(slot); code != LIBUSB_SUCCESS) { return code; }
    }
    return LIBUSB_SUCCESS;
}

void BulkInStream::cancel_all() {
    for (const Slot& slot : slots_) {
        // A refusal means that the completion is already under way.
        if (slot.in_flight) { static_cast<void>(libusb_cancel_transfer(slot.transfer)); }
    }
}

void BulkInStream::on_complete(Slot& slot) {
    slot.in_flight = false;
    --in_flight_;
    const auto received_bytes = static_cast<std::size_t>(slot.transfer->actual_length);
    const int status = slot.transfer->status;
    tell_completion(slot, kernel_status_of_transfer(status), {slot.transfer->buffer, received_bytes});

    if (state_ == State::running) { judge(status, received_bytes); }
    if (state_ == State::clearing_halt && status == LIBUSB_TRANSFER_NO_DEVICE) {
        begin_end(End::device_lost, usb_error("read from the board", LIBUSB_ERROR_NO_DEVICE));
    }
    if (state_ == State::running && !slot.retired) {
        const int code = submit(slot);
        if (code == LIBUSB_ERROR_NO_DEVICE) {
            begin_end(End::device_lost, usb_error("read from the board", code));
        } else if (code != LIBUSB_SUCCESS && in_flight_ == 0) {
            begin_end(End::failed, usb_error("queue a bulk transfer", code));
        }
    }
    if (in_flight_ == 0 && state_ != State::running) { when_none_in_flight(); }
}

void BulkInStream::tell_completion(const Slot& slot, int kernel_status, ByteView data) {
    Transfer told;
    told.event = Transfer::Event::completion;
    told.endpoint = endpoint_;
    told.id = slot.id;
    told.status = kernel_status;
    told.requested_bytes = slot.bytes;
    told.time = host_now();
    told.data = data;
    observer_.on_usb_transfer(told);
}

void BulkInStream::on_event_failure(const Error& error) {
    for (Slot& slot : slots_) {
        if (!slot.in_flight) { continue; }
        slot.in_flight = false;
        --in_flight_;
        usb_.keep(std::exchange(slot.transfer, nullptr));
        tell_completion(slot, -ESHUTDOWN, {});
    }
    end_ = End::device_lost;
    error_ = error;
    finish();
}

void BulkInStream::judge(int status, std::size_t received_bytes) {
    if (received_bytes > 0) {
        stalls_in_row_ = 0;
        empty_in_row_ = 0;
    }
    switch (status) {
        case LIBUSB_TRANSFER_COMPLETED:
            errors_in_row_ = 0;
            if (received_bytes == 0) { count_empty(); }
            return;
        case LIBUSB_TRANSFER_NO_DEVICE:
            begin_end(End::device_lost, usb_error("read from the board", LIBUSB_ERROR_NO_DEVICE));
            return;
        case LIBUSB_TRANSFER_STALL:
            if (++stalls_in_row_ > stall_limit) {
                begin_end(End::failed, usb_error("read from the board, again and again", LIBUSB_ERROR_PIPE));
                return;
            }
            // USB 2.0 section 5.8.5: nothing may be queued on a halted endpoint when its halt is cleared.
            state_ = State::clearing_halt;
            cancel_all();
            return;
        default:
            if (++errors_in_row_ > std::max(plan_.transfers, errors_in_row_min)) {
                begin_end(End::device_lost,
                          Error{ErrorCode::device_lost,
                                "read from the board: nothing but bus errors; check cable and hub"});
            }
    }
}

void BulkInStream::count_empty() {
    const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
    if (empty_in_row_ == 0) { first_empty_ns_ = now_ns; }
    if (++empty_in_row_ < empty_limit) { return; }
    if (now_ns - first_empty_ns_ < empty_limit_window_ns) {
        begin_end(End::failed, Error{ErrorCode::malformed, "read from the board: a flood of empty packets"});
    }
    empty_in_row_ = 0;
}

void BulkInStream::begin_end(End end, std::optional<Error> error) {
    if (state_ == State::ending) { return; }
    state_ = State::ending;
    end_ = end;
    error_ = std::move(error);
    cancel_all();
}

void BulkInStream::when_none_in_flight() {
    if (state_ == State::clearing_halt) {
        // libusb calls this blocking; on Linux it is one ioctl and needs no event handling. Its own failure
        // needs no answer unless the device is gone: the next transfer stalls again, and that is counted.
        int code = libusb_clear_halt(device_, endpoint_);
        if (code != LIBUSB_ERROR_NO_DEVICE) {
            state_ = State::running;
            code = submit_all();
            if (in_flight_ > 0) { return; }
        }
        const End end = code == LIBUSB_ERROR_NO_DEVICE ? End::device_lost : End::failed;
        begin_end(end, usb_error("queue bulk transfers after a stall", code));
    }
    finish();
}

void BulkInStream::finish() {
    state_ = State::idle;
    usb_.remove(*this);
    // The handler goes first: when stop() returns, the end has been told.
    const EndHandler on_end = std::exchange(on_end_, nullptr);
    if (on_end) { on_end(end_, error_); }
    const std::lock_guard lock(mutex_);
    ended_ = true;
    ended_changed_.notify_all();
}

}  // namespace gyrolog
