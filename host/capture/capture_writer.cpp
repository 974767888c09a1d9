#include "host/capture/capture_writer.hpp"

#include <algorithm>
#include <utility>

#include "host/base/program_name.hpp"
#include "host/capture/head_records.hpp"
#include "host/capture/pcapng.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t transfer_bytes_max = pcapng::packet_bytes_max - usbmon_header_bytes;

}  // namespace

Result<CaptureWriter> CaptureWriter::create(std::unique_ptr<AppendFile> file, const SourceIdentity& identity,
                                            HostTime started, const std::optional<CaptureSegment>& segment) {
    CaptureWriter writer(std::move(file), identity, started);
    writer.append_head(identity, segment);
    GYROLOG_CHECK(writer.flush());
    return writer;
}

// Wireshark takes an address of 0 for a device that is still being enumerated.
CaptureWriter::CaptureWriter(std::unique_ptr<AppendFile> file, const SourceIdentity& identity,
                             HostTime started)
    : file_(std::move(file)),
      address_{std::max<std::uint16_t>(identity.bus_number, 1),
               std::max<std::uint8_t>(identity.device_address, 1)},
      started_(started) {
    buffer_.reserve(buffer_bytes + pcapng::packet_bytes_max);
}

void CaptureWriter::append_head(const SourceIdentity& identity,
                                const std::optional<CaptureSegment>& segment) {
    pcapng::append_section_header(buffer_, metadata_json({program_name(), identity, started_, segment}),
                                  program_name());
    block_ends_.push_back(buffer_.size());
    pcapng::append_interface(buffer_, link_type_usb_linux_mmapped, identity.uri.substr(0, 255));
    block_ends_.push_back(buffer_.size());
    for_each_head_record(identity, started_, [this](const Transfer& transfer) { append_record(transfer); });
}

// The monotonic clock, put on real time once for the whole file: a step of the host's clock changes no time
// stamp.
std::int64_t CaptureWriter::file_time_ns(HostTime time) const {
    return std::max<std::int64_t>(started_.realtime_ns + (time.monotonic_ns - started_.monotonic_ns), 0);
}

void CaptureWriter::append_record(const Transfer& transfer) {
    const std::int64_t time_ns = file_time_ns(transfer.time);
    pcapng::append_packet(buffer_, time_ns,
                          [&](Bytes& out) { append_usbmon_record(out, transfer, address_, time_ns); });
    block_ends_.push_back(buffer_.size());
}

Status CaptureWriter::append(const Transfer& transfer) {
    if (failed_) { return *failed_; }
    if (transfer.data.size() > transfer_bytes_max) {
        return Error{ErrorCode::invalid_argument, "a transfer of " + std::to_string(transfer.data.size()) +
                                                      " bytes is longer than a capture holds"};
    }
    append_record(transfer);
    ++transfers_;
    if (transfer.carries_stream()) { stream_bytes_ += transfer.data.size(); }
    return write_full_buffer();
}

Status CaptureWriter::write_full_buffer() { return buffer_.size() >= buffer_bytes ? flush() : Status(); }

void CaptureWriter::append_statistics(HostTime now, std::string_view comment) {
    pcapng::append_statistics(buffer_, file_time_ns(now), comment, transfers_ + counters_.transfers_dropped,
                              counters_.transfers_dropped);
    block_ends_.push_back(buffer_.size());
}

void CaptureWriter::append_checkpoint(const CaptureCounters& counters, HostTime now, bool last) {
    counters_ = counters;
    append_statistics(now, checkpoint_json({now, transfers_, stream_bytes_, counters, last}));
}

Status CaptureWriter::checkpoint(const CaptureCounters& counters, HostTime now) {
    if (failed_) { return *failed_; }
    append_checkpoint(counters, now, false);
    return write_full_buffer();
}

Status CaptureWriter::mark(CaptureMark mark) {
    if (failed_) { return *failed_; }
    mark.stream_bytes = stream_bytes_;
    append_statistics(mark.time, mark_json(mark));
    return write_full_buffer();
}

Status CaptureWriter::sync() {
    GYROLOG_CHECK(flush());
    if (Status synced = file_->sync(); !synced.ok()) { return fail(std::move(synced).error(), 0); }
    return {};
}

Status CaptureWriter::sync_soon() {
    GYROLOG_CHECK(flush());
    if (Status begun = file_->begin_sync(); !begun.ok()) { return fail(std::move(begun).error(), 0); }
    return {};
}

Status CaptureWriter::close() {
    if (!failed_) { append_checkpoint(counters_, host_now(), true); }
    const Status synced = sync();
    Status closed = file_->close();
    if (synced.ok() && !closed.ok()) { failed_ = closed.error(); }
    if (!failed_) { return {}; }
    return *failed_;
}

Status CaptureWriter::flush() {
    if (failed_) { return *failed_; }
    std::size_t written = 0;
    while (written < buffer_.size()) {
        auto taken = file_->write(ByteView(buffer_).subspan(written));
        if (!taken.ok()) { return fail(std::move(taken).error(), written); }
        written += *taken;
    }
    file_bytes_ += written;
    buffer_.clear();
    block_ends_.clear();
    return {};
}

Status CaptureWriter::fail(Error error, std::size_t buffered_bytes_written) {
    const auto torn = std::upper_bound(block_ends_.begin(), block_ends_.end(), buffered_bytes_written);
    file_bytes_ += torn == block_ends_.begin() ? 0 : *(torn - 1);
    buffer_.clear();
    block_ends_.clear();
    if (const Status cut = file_->truncate(file_bytes_); !cut.ok()) {
        error.message += "; the file ends in half a block (" + cut.error().message + ")";
    }
    failed_ = error;
    return error;
}

}  // namespace gyrolog
