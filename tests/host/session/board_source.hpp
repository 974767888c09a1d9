// A device behind the session's seam that behaves as it is told: the virtual board on a line of any kind, or
// somebody else who answers in its place.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <gtest/gtest.h>
#include <gyrolog_protocol/usb_identity.h>

#include "host/transport/byte_source.hpp"
#include "host/virtual_board/virtual_board.hpp"

namespace gyrolog {

struct SourceManner {
    bool has_line = true;
    bool can_wait = false;
    // Board time and host time of one turn: all that came in a turn is delivered at once.
    double turn_board_s = 0.020;
    double turn_host_s = 0.001;
    std::size_t transfer_bytes = 512;
    bool streams_before_start = false;  // left running for 3 s by whoever used the board before
    bool lost_when_written_to = false;  // unplugged by the first command
    // While it streams, board time stands still from here on.
    std::optional<double> frozen_from_s = std::nullopt;
    std::optional<double> restarted_at_s = std::nullopt;  // once, by somebody else
    // Comes in the board's place once the line is raised.
    std::optional<Bytes> speaks_instead = std::nullopt;
};

class BoardSource final : public ByteSource {
public:
    static std::unique_ptr<BoardSource> create(const SourceManner& manner, VirtualBoardOptions options = {}) {
        if (options.rate_hz == 0.0) { options.rate_hz = 1000.0; }
        if (options.dlpf_hz == 0) { options.dlpf_hz = 184; }
        auto board = VirtualBoard::create(std::move(options));
        EXPECT_TRUE(board.ok());
        if (!board.ok()) { return nullptr; }
        return std::unique_ptr<BoardSource>(new BoardSource(manner, std::move(board).value()));
    }
    BoardSource(const BoardSource&) = delete;
    BoardSource& operator=(const BoardSource&) = delete;
    ~BoardSource() override { BoardSource::stop(); }

    const SourceIdentity& identity() const override { return identity_; }
    bool can_wait() const override { return manner_.can_wait; }
    double tolerated_stall_s(double /*bytes_per_s*/, double /*bytes_per_frame*/) const override {
        return std::numeric_limits<double>::infinity();
    }

    Status start(TransferSink& sink) override {
        sink_ = &sink;
        if (manner_.streams_before_start) { let_it_run(3.0); }
        thread_ = std::thread([this] { run(); });
        return {};
    }

    Status set_line_state(bool data_terminal_ready) override {
        const std::lock_guard lock(mutex_);
        if (!manner_.has_line) { return Error{ErrorCode::unsupported, "set DTR: no such line"}; }
        if (ended_) { return Error{ErrorCode::device_lost, "set DTR: the board is gone"}; }
        line_raised_ = data_terminal_ready;
        tell_line_state(data_terminal_ready);
        Transfer request;
        request.kind = TransferKind::control;
        request.setup = {0x21, GLP_CDC_SET_CONTROL_LINE_STATE,
                         static_cast<std::uint8_t>(data_terminal_ready ? GLP_CDC_LINE_DTR : 0)};
        tell(request, {}, {});
        if (!manner_.speaks_instead) { board_->on_line_state(data_terminal_ready); }
        return {};
    }

    Status write(ByteView bytes) override {
        const std::lock_guard lock(mutex_);
        if (ended_) { return Error{ErrorCode::device_lost, "write: the board is gone"}; }
        ++writes_;
        Transfer sent;
        sent.endpoint = line_endpoint_out;
        sent.requested_bytes = static_cast<std::uint32_t>(bytes.size());
        tell(sent, bytes, {});
        if (manner_.lost_when_written_to) {
            board_->fault({BoardFault::Kind::unplug, 0.0, 0.0});
        } else if (!manner_.speaks_instead) {
            board_->on_receive(bytes);
        }
        return {};
    }

    void stop() override {
        stop_wanted_ = true;
        if (thread_.joinable()) { thread_.join(); }
    }
    void let_go() override {
        EXPECT_FALSE(thread_.joinable()) << "before stop()";
        was_let_go_ = true;
    }

    // The following: after stop().
    const Bytes& delivered() const { return delivered_; }  // the stream as the sink took it
    std::uint64_t transfers_refused() const { return transfers_refused_; }
    std::uint64_t bytes_refused() const { return bytes_refused_; }
    bool line_raised() const { return line_raised_; }
    bool was_let_go() const { return was_let_go_; }
    int writes() const { return writes_; }
    const VirtualBoard& board() const { return *board_; }

private:
    BoardSource(const SourceManner& manner, std::unique_ptr<VirtualBoard> board)
        : manner_(manner), board_(std::move(board)) {
        identity_.uri = "test:board";
        identity_.serial = board_->serial();
        board_->in_endpoint().set_capacity(std::size_t{1} << 20U);  // the bus is always fast enough
    }

    void let_it_run(double time_s) {
        board_->on_line_state(true);
        board_->advance_to(board_->now_ns() + to_ns(time_s));
        board_->in_endpoint().clear();
    }

    void run() {
        while (!stop_wanted_) {
            {
                const std::lock_guard lock(mutex_);
                if (!turn()) {
                    ended_ = true;
                    break;
                }
            }
            std::this_thread::sleep_for(std::chrono::nanoseconds(to_ns(manner_.turn_host_s)));
        }
        if (board_->unplugged()) {
            sink_->on_end(SourceEnd::device_lost, Error{ErrorCode::device_lost, "test:board: unplugged"});
        } else {
            sink_->on_end(SourceEnd::stopped, std::nullopt);
        }
    }

    // False once the board is gone.
    bool turn() {
        if (manner_.speaks_instead) {
            if (line_raised_ && !spoken_) { deliver(*manner_.speaks_instead); }
            spoken_ = line_raised_;
            return true;
        }
        if (manner_.restarted_at_s && !restarted_ && streamed_s() >= *manner_.restarted_at_s) {
            restarted_ = true;
            board_->on_line_state(false);
            board_->on_line_state(true);
        }
        if (!frozen()) { board_->advance_to(board_->now_ns() + to_ns(manner_.turn_board_s)); }
        Bytes buffer(manner_.transfer_bytes);
        while (const std::size_t size = board_->in_endpoint().take_bytes(buffer)) {
            deliver(ByteView(buffer).first(size));
        }
        return !board_->unplugged();
    }

    bool frozen() const { return manner_.frozen_from_s && streamed_s() >= *manner_.frozen_from_s; }
    double streamed_s() const {
        if (!board_->streaming()) { return 0.0; }
        return static_cast<double>(board_->now_ns() - *board_->first_start_ns()) * 1e-9;
    }

    void deliver(ByteView data) {
        Transfer transfer;
        transfer.endpoint = line_endpoint_in;
        transfer.requested_bytes = static_cast<std::uint32_t>(manner_.transfer_bytes);
        tell(transfer, {}, data);
    }

    void tell(Transfer transfer, ByteView submitted, ByteView completed) {
        transfer.id = ++last_id_;
        transfer.time = host_now();
        transfer.event = Transfer::Event::submission;
        transfer.data = submitted;
        hand_over(transfer);
        transfer.event = Transfer::Event::completion;
        transfer.data = completed;
        hand_over(transfer);
    }

    void tell_line_state(bool data_terminal_ready) {
        Transfer transfer;
        transfer.kind = TransferKind::control;
        transfer.id = ++last_id_;
        transfer.setup = {0x21, GLP_CDC_SET_CONTROL_LINE_STATE,
                          static_cast<std::uint8_t>(data_terminal_ready ? GLP_CDC_LINE_DTR : 0)};
        transfer.time = host_now();
        transfer.event = Transfer::Event::submission;
        hand_over(transfer);
        transfer.event = Transfer::Event::completion;
        hand_over(transfer);
    }

    void hand_over(const Transfer& transfer) {
        bool taken = sink_->on_transfer(transfer);
        while (!taken && manner_.can_wait && !stop_wanted_) {
            std::this_thread::yield();
            taken = sink_->on_transfer(transfer);
        }
        if (!taken) {
            ++transfers_refused_;
            bytes_refused_ += transfer.data.size();
        } else if (transfer.carries_stream()) {
            delivered_.insert(delivered_.end(), transfer.data.begin(), transfer.data.end());
        }
    }

    static std::int64_t to_ns(double time_s) { return static_cast<std::int64_t>(time_s * 1e9); }

    const SourceManner manner_;
    SourceIdentity identity_;
    TransferSink* sink_ = nullptr;
    std::thread thread_;
    std::atomic<bool> stop_wanted_{false};

    std::mutex mutex_;  // for all that follows while the thread runs
    std::unique_ptr<VirtualBoard> board_;
    bool ended_ = false;
    bool line_raised_ = false;
    bool spoken_ = false;
    bool was_let_go_ = false;
    bool restarted_ = false;
    int writes_ = 0;
    std::uint64_t last_id_ = 0;
    Bytes delivered_;
    std::uint64_t transfers_refused_ = 0;
    std::uint64_t bytes_refused_ = 0;
};

}  // namespace gyrolog
