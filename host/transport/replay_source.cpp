#include "host/transport/replay_source.hpp"

#include <chrono>
#include <limits>
#include <utility>

namespace gyrolog {
namespace {

constexpr std::chrono::microseconds retry_interval(200);

}  // namespace

Result<std::unique_ptr<ReplaySource>> ReplaySource::open(const std::string& path) {
    GYROLOG_TRY(CaptureReader reader, CaptureReader::open(path));
    return std::unique_ptr<ReplaySource>(new ReplaySource(std::move(reader), path));
}

ReplaySource::ReplaySource(CaptureReader reader, const std::string& path) : reader_(std::move(reader)) {
    if (reader_.metadata()) { identity_ = reader_.metadata()->source; }
    identity_.uri = "replay:" + path;
}

ReplaySource::~ReplaySource() { stop(); }

double ReplaySource::tolerated_stall_s(double /*bytes_per_s*/, double /*bytes_per_frame*/) const {
    return std::numeric_limits<double>::infinity();
}

Status ReplaySource::start(TransferSink& sink) {
    if (thread_.joinable() || stopping_) {
        return Error{ErrorCode::invalid_argument, identity_.uri + " was started before"};
    }
    thread_ = std::thread([this, &sink] { play(sink); });
    return {};
}

Status ReplaySource::set_line_state(bool /*data_terminal_ready*/) {
    return Error{ErrorCode::unsupported, identity_.uri + " has no control lines"};
}

Status ReplaySource::write(ByteView /*bytes*/) {
    return Error{ErrorCode::unsupported, identity_.uri + " takes no commands"};
}

void ReplaySource::stop() {
    stopping_ = true;
    if (thread_.joinable()) { thread_.join(); }
}

void ReplaySource::play(TransferSink& sink) {
    while (true) {
        auto captured = reader_.next();
        if (!captured.ok()) {
            sink.on_end(SourceEnd::failed, captured.error());
            return;
        }
        if (!captured->has_value()) {
            sink.on_end(SourceEnd::exhausted, std::nullopt);
            return;
        }
        if (!deliver(sink, (*captured)->transfer)) {
            sink.on_end(SourceEnd::stopped, std::nullopt);
            return;
        }
    }
}

// False when stop() was called before the sink had room.
bool ReplaySource::deliver(TransferSink& sink, const Transfer& transfer) const {
    while (!stopping_) {
        if (sink.on_transfer(transfer)) { return true; }
        std::this_thread::sleep_for(retry_interval);
    }
    return false;
}

}  // namespace gyrolog
