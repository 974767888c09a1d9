#include "host/capture/segment_writer.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <random>
#include <utility>

#include "host/base/byte_size.hpp"
#include "host/capture/segment_files.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t name_number_max = 1'000'000;

// Two captures must not be taken for one: a clock may be set back, a random number alone may be a poor one.
std::string new_capture_name() {
    std::random_device random;
    const std::uint64_t high = random();
    const std::uint64_t name =
        ((high << 32U) | random()) ^ static_cast<std::uint64_t>(clock_ns(CLOCK_REALTIME));
    std::array<char, 17> text{};
    static_cast<void>(
        std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(name)));
    return text.data();
}

}  // namespace

Result<SegmentWriter> SegmentWriter::create(SegmentPlan plan, const SourceIdentity& identity, Disk& disk) {
    SegmentWriter writer(std::move(plan), identity, disk);
    writer.capture_ = new_capture_name();
    GYROLOG_CHECK(writer.check_room());
    GYROLOG_CHECK(writer.open_next());
    return writer;
}

Status SegmentWriter::check_room() {
    if (plan_.min_free_bytes == 0) { return {}; }
    GYROLOG_TRY(const std::uint64_t free_bytes, disk_->free_bytes(plan_.path));
    const std::uint64_t spoken_for = plan_.min_free_bytes + (file_ ? file_->bytes_buffered() : 0);
    if (free_bytes > spoken_for) {
        room_until_bytes_ = bytes_written() + (free_bytes - spoken_for);
        return {};
    }
    return Error{ErrorCode::disk_full,
                 "write '" + (paths_.empty() ? plan_.path : paths_.back()) + "': the disk has " +
                     format_bytes(free_bytes) + " left, and " + format_bytes(plan_.min_free_bytes) +
                     " are to stay free (--min-free); make room, or choose another disk"};
}

Result<std::unique_ptr<AppendFile>> SegmentWriter::create_file() {
    while (true) {
        ++name_number_;
        const bool first = number_ == 0;
        const std::string path = segment_path(plan_.path, name_number_);
        auto file = disk_->create(path, first && plan_.overwrite ? IfExists::replace : IfExists::refuse);
        if (file.ok()) {
            paths_.push_back(path);
            return file;
        }
        Error error = std::move(file).error();
        const bool taken = error.code == ErrorCode::invalid_argument;
        if (taken && !first && name_number_ < name_number_max) { continue; }
        if (taken) { error.message += "; choose another name or --force"; }
        return error;
    }
}

Status SegmentWriter::open_next() {
    std::error_code unknown;
    if (number_ == 0) { replaces_ = std::filesystem::is_regular_file(plan_.path, unknown); }
    GYROLOG_TRY(std::unique_ptr<AppendFile> file, create_file());
    ++number_;
    auto writer = CaptureWriter::create(std::move(file), identity_, host_now(),
                                        CaptureSegment{capture_, number_, connection_});
    if (!writer.ok()) {
        forget_file();
        return std::move(writer).error();
    }
    file_.emplace(std::move(writer).value());
    first_transfer_ns_.reset();
    return {};
}

bool SegmentWriter::is_due(const Transfer& transfer) {
    if (!first_transfer_ns_) { first_transfer_ns_ = transfer.time.monotonic_ns; }
    if (file_->transfers() == 0) { return false; }
    const double age_s = static_cast<double>(transfer.time.monotonic_ns - *first_transfer_ns_) * 1e-9;
    return (plan_.rotate_bytes && file_->bytes_written() >= *plan_.rotate_bytes) ||
           (plan_.rotate_s && age_s >= *plan_.rotate_s);
}

Status SegmentWriter::rotate() {
    GYROLOG_CHECK(file_->checkpoint(counters_));
    GYROLOG_CHECK(close());
    return open_next();
}

Status SegmentWriter::append(const Transfer& transfer) {
    if (!file_) { return Error{ErrorCode::storage_failed, "write '" + plan_.path + "': it is closed"}; }
    if (is_due(transfer)) {
        GYROLOG_CHECK(rotate());
        first_transfer_ns_ = transfer.time.monotonic_ns;
    }
    GYROLOG_CHECK(file_->append(transfer));
    return keep_room();
}

// A source that does not wait for the clock fills a small disk between two checkpoints.
Status SegmentWriter::keep_room() { return bytes_written() < room_until_bytes_ ? Status() : check_room(); }

Status SegmentWriter::mark(CaptureMark mark) {
    if (!file_) { return Error{ErrorCode::storage_failed, "write '" + plan_.path + "': it is closed"}; }
    return file_->mark(std::move(mark));
}

Status SegmentWriter::checkpoint(const CaptureCounters& counters) {
    counters_ = counters;
    if (!file_) { return {}; }
    GYROLOG_CHECK(file_->checkpoint(counters));
    return check_room();
}

Status SegmentWriter::take_place() {
    if (placed_ || !file_) { return {}; }
    GYROLOG_CHECK(file_->flush());
    placed_ = true;
    return file_->take_place();
}

Status SegmentWriter::flush() { return file_ ? file_->flush() : Status(); }

Status SegmentWriter::sync() { return file_ ? file_->sync() : Status(); }

Status SegmentWriter::sync_soon() { return file_ ? file_->sync_soon() : Status(); }

Status SegmentWriter::close() {
    if (!file_) { return {}; }
    Status closed = file_->close();
    closed_bytes_ += file_->bytes_written();
    file_.reset();
    return closed;
}

Status SegmentWriter::begin_connection(const SourceIdentity& identity) {
    identity_ = identity;
    ++connection_;
    GYROLOG_CHECK(check_room());
    return open_next();
}

void SegmentWriter::drop() {
    if (!file_) { return; }
    static_cast<void>(file_->close());
    file_.reset();
    forget_file();
    --connection_;
}

// Of the file that was made last. A device or a pipe was there before, and so was what a first file was to
// replace.
void SegmentWriter::forget_file() {
    std::error_code unknown;
    const bool is_old = paths_.size() == 1 && keeps_old();
    if (!is_old && std::filesystem::is_regular_file(paths_.back(), unknown)) {
        std::filesystem::remove(paths_.back(), unknown);
    }
    paths_.pop_back();
    --number_;
    --name_number_;
}

}  // namespace gyrolog
