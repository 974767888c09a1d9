// Writes a capture as one file or several: a file that is long enough ends between two transfers, and the
// next one goes on with the same stream; a board that comes back begins one, too.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/base/result.hpp"
#include "host/capture/append_file.hpp"
#include "host/capture/capture_writer.hpp"

namespace gyrolog {

struct SegmentPlan {
    std::string path;  // of the first; the others are named after it (segment_files.hpp)
    bool overwrite = false;
    std::optional<std::uint64_t> rotate_bytes;  // a file that has reached so much is followed by the next
    std::optional<double> rotate_s;             // the same by the time since its first transfer
    std::uint64_t min_free_bytes = 0;           // of the disk, for others
};

// What CaptureWriter promises holds for each file. Files of numbers above 1 that exist are never overwritten:
// the next free number is taken.
class SegmentWriter {
public:
    // Errors: those of CaptureWriter::create; disk_full when there is less room than is to be kept free, and
    // then no file is made.
    static Result<SegmentWriter> create(SegmentPlan plan, const SourceIdentity& identity, Disk& disk);

    // Error disk_full as checkpoint() has it, before what is to be kept free is touched.
    Status append(const Transfer& transfer);
    // In the present file.
    Status mark(CaptureMark mark);
    // Error disk_full, with the checkpoint appended and the writer unharmed: no more than is to be kept free
    // is left.
    Status checkpoint(const CaptureCounters& counters);
    Status flush();
    Status sync();
    // The same soon, without waiting for the disk.
    Status sync_soon();

    // A file that replaces another does so now, if it has not yet, with all that was appended in it; closed
    // before, it is gone.
    Status take_place();
    // Whether the file that was to be replaced is still there.
    bool keeps_old() const { return replaces_ && !placed_; }

    // Closes the present file, without another one yet. Harmless when there is none.
    Status close();
    // The board is back: the next file, after close().
    Status begin_connection(const SourceIdentity& identity);
    // Takes the file that begin_connection() made away again: nothing came.
    void drop();

    // In all files.
    std::uint64_t bytes_written() const { return closed_bytes_ + (file_ ? file_->bytes_written() : 0); }
    // Transfers in the present file.
    std::uint64_t transfers() const { return file_ ? file_->transfers() : 0; }
    const std::vector<std::string>& paths() const { return paths_; }

private:
    SegmentWriter(SegmentPlan plan, SourceIdentity identity, Disk& disk)
        : plan_(std::move(plan)), identity_(std::move(identity)), disk_(&disk) {}

    Status open_next();
    void forget_file();
    Result<std::unique_ptr<AppendFile>> create_file();
    Status check_room();
    Status keep_room();
    bool is_due(const Transfer& transfer);
    Status rotate();

    SegmentPlan plan_;
    SourceIdentity identity_;
    Disk* disk_;
    std::string capture_;  // CaptureSegment::capture
    std::uint64_t number_ = 0;
    bool replaces_ = false;
    bool placed_ = false;
    std::uint64_t name_number_ = 0;
    std::uint64_t connection_ = 1;
    std::optional<CaptureWriter> file_;
    std::optional<std::int64_t> first_transfer_ns_;  // of the present file
    CaptureCounters counters_;                       // of the last checkpoint
    std::uint64_t closed_bytes_ = 0;
    std::uint64_t room_until_bytes_ = 0;  // bytes_written() up to which the last look at the disk holds
    std::vector<std::string> paths_;
};

}  // namespace gyrolog
