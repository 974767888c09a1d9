// Writes a capture file: every transfer as it came, in pcapng (FORMAT.md).
//
// Promise to the user: whatever kills the process or the machine, every transfer appended before the last
// successful sync() is read back, in order and bit for bit, and nothing that was not appended is ever read
// back. A killed process on a living machine loses at most what was appended since the last successful
// flush() or sync().
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/base/bytes.hpp"
#include "host/base/clock.hpp"
#include "host/base/result.hpp"
#include "host/capture/append_file.hpp"
#include "host/capture/capture_counters.hpp"
#include "host/capture/capture_metadata.hpp"
#include "host/capture/usbmon_record.hpp"
#include "host/transport/byte_source.hpp"
#include "host/transport/transfer.hpp"

namespace gyrolog {

class CaptureWriter {
public:
    // So much waits in memory at most. Where each write waits for the disk, few large ones keep up with a
    // stream that many small ones fall behind.
    static constexpr std::size_t buffer_bytes = std::size_t{1} << 20U;

    // Errors: those of the file.
    static Result<CaptureWriter> create(std::unique_ptr<AppendFile> file, const SourceIdentity& identity,
                                        HostTime started,
                                        const std::optional<CaptureSegment>& segment = std::nullopt);

    // After any storage error the writer is finished: the file is cut back to its last whole block, and every
    // later call repeats the first error. Writing on would bury half a block in the middle of the file.
    //
    // What is appended waits in memory until the next flush() or sync(), or until buffer_bytes wait.
    //
    // Error invalid_argument, with nothing appended and the writer unharmed: more than 256 KiB in one
    // transfer.
    Status append(const Transfer& transfer);
    // Once a second or once a MiB, whichever comes first: where a reader of a long or damaged file finds its
    // feet.
    Status checkpoint(const CaptureCounters& counters) { return checkpoint(counters, host_now()); }
    Status checkpoint(const CaptureCounters& counters, HostTime now);
    // Its place in the file is here and now.
    Status mark(CaptureMark mark);
    // Everything appended so far is in the file, and survives the end of this process.
    Status flush();
    // Everything appended so far survives a loss of power.
    Status sync();
    // The same soon, without waiting for the disk; a failure is told by the next call.
    Status sync_soon();
    // See AppendFile.
    Status take_place() { return file_->take_place(); }
    // Syncs. A writer that is destroyed without close() leaves what a kill would leave.
    Status close();

    // Length of the file once the buffer is in it.
    std::uint64_t bytes_written() const { return file_bytes_ + buffer_.size(); }
    // Of them, those that the disk has not seen yet.
    std::size_t bytes_buffered() const { return buffer_.size(); }
    std::uint64_t transfers() const { return transfers_; }

private:
    CaptureWriter(std::unique_ptr<AppendFile> file, const SourceIdentity& identity, HostTime started);

    void append_head(const SourceIdentity& identity, const std::optional<CaptureSegment>& segment);
    void append_checkpoint(const CaptureCounters& counters, HostTime now, bool last);
    void append_record(const Transfer& transfer);
    void append_statistics(HostTime now, std::string_view comment);
    std::int64_t file_time_ns(HostTime time) const;
    Status write_full_buffer();
    Status fail(Error error, std::size_t buffered_bytes_written);

    std::unique_ptr<AppendFile> file_;
    std::optional<Error> failed_;
    UsbAddress address_;
    HostTime started_;
    Bytes buffer_;                         // whole blocks
    std::vector<std::size_t> block_ends_;  // in the buffer
    std::uint64_t file_bytes_ = 0;
    std::uint64_t transfers_ = 0;
    std::uint64_t stream_bytes_ = 0;
    CaptureCounters counters_;  // of the last checkpoint
};

}  // namespace gyrolog
