// The writer on disks that are full, slow, or broken.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/host/capture/made_capture.hpp"

namespace gyrolog {
namespace {

TEST(CaptureWriter, FullDiskStopsItForGoodAndKeepsWhatFitted) {
    const MadeCapture whole = make_capture(30, 400);
    for (std::size_t capacity = whole.head_end; capacity < whole.bytes.size(); capacity += 97) {
        FakeDisk disk;
        disk.capacity_bytes = capacity;
        auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
        ASSERT_TRUE(writer.ok());
        std::optional<Error> first;
        for (const KeptTransfer& transfer : whole.transfers) {
            Status status = writer->append(transfer.view());
            if (status.ok()) { status = writer->sync(); }
            if (!status.ok() && !first) {
                first = status.error();
                disk.capacity_bytes = 1U << 30U;  // space comes free, too late
            } else if (first) {
                ASSERT_FALSE(status.ok());
                ASSERT_EQ(status.error().message, first->message);
            }
        }
        const Status closed = writer->close();
        if (!first) { continue; }
        ASSERT_EQ(first->code, ErrorCode::disk_full);
        ASSERT_FALSE(closed.ok());
        ASSERT_TRUE(disk.closed);
        ASSERT_EQ(disk.writes_after_failure, 0);
        ASSERT_EQ(writer->bytes_written(), disk.contents.size());

        const auto read = read_capture(disk.contents);
        ASSERT_TRUE(read.ok());
        ASSERT_EQ(read->accounts.blocks.end, FileEnd::clean) << capacity;
        std::size_t fitting = 0;
        for (std::size_t end = disk.contents.size(); fitting < read->transfers.size(); ++fitting) {
            ASSERT_EQ(read->transfers[fitting], whole.transfers[fitting]);
            ASSERT_LE(read->offsets[fitting], end);
        }
        ASSERT_GT(disk.contents.size() + 600, capacity) << "more was thrown away than one block";
    }
}

TEST(CaptureWriter, ShortWritesLeaveTheSameFile) {
    const std::vector<KeptTransfer> transfers = made_transfers(30, 400);
    Bytes expected;
    for (const std::size_t bytes_per_write :
         {std::size_t{1'000'000}, std::size_t{1}, std::size_t{7}, std::size_t{333}}) {
        FakeDisk disk;
        disk.bytes_per_write = bytes_per_write;
        auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
        ASSERT_TRUE(writer.ok());
        for (const KeptTransfer& transfer : transfers) { ASSERT_TRUE(writer->append(transfer.view()).ok()); }
        ASSERT_TRUE(writer->sync().ok());
        if (expected.empty()) { expected = disk.contents; }
        EXPECT_EQ(disk.contents, expected);
        EXPECT_EQ(disk.synced_bytes, expected.size());
    }
}

TEST(CaptureWriter, SyncedTransfersSurviveTheLossOfEverythingElse) {
    const std::vector<KeptTransfer> transfers = made_transfers(30, 400);
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
    ASSERT_TRUE(writer.ok());
    for (std::size_t i = 0; i < transfers.size(); ++i) {
        ASSERT_TRUE(writer->append(transfers[i].view()).ok());
        if (i == 20) { ASSERT_TRUE(writer->sync().ok()); }
    }
    disk.contents.resize(disk.synced_bytes);
    const auto read = read_capture(disk.contents);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->transfers.size(), 21U);
}

TEST(CaptureWriter, HoldsWhatIsAppendedUntilItIsFlushedOrMuch) {
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
    ASSERT_TRUE(writer.ok());
    const std::size_t head = disk.contents.size();
    const Bytes data(10'000);
    Transfer transfer;
    transfer.endpoint = 0x81;
    transfer.data = data;
    ASSERT_TRUE(writer->append(transfer).ok());
    ASSERT_TRUE(writer->checkpoint({}, made_start).ok());
    ASSERT_TRUE(writer->mark({made_start, "lamp on", 0}).ok());
    EXPECT_EQ(disk.contents.size(), head);
    ASSERT_TRUE(writer->flush().ok());
    EXPECT_EQ(disk.contents.size(), writer->bytes_written());
    const std::size_t flushed = disk.contents.size();
    while (disk.contents.size() == flushed && writer->bytes_written() < 2 * CaptureWriter::buffer_bytes) {
        ASSERT_TRUE(writer->append(transfer).ok());
    }
    EXPECT_GE(disk.contents.size() - flushed, CaptureWriter::buffer_bytes);
    EXPECT_LE(disk.contents.size() - flushed, CaptureWriter::buffer_bytes + 2 * data.size());
}

TEST(CaptureWriter, ReportsARefusedSyncAndAFailedCut) {
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
    ASSERT_TRUE(writer.ok());
    disk.sync_error = Error{ErrorCode::storage_failed, "sync: input/output error"};
    disk.truncate_error = Error{ErrorCode::storage_failed, "truncate: read-only file system"};
    const Status synced = writer->sync();
    ASSERT_FALSE(synced.ok());
    EXPECT_EQ(synced.error().code, ErrorCode::storage_failed);
    EXPECT_NE(synced.error().message.find("read-only"), std::string::npos);
    EXPECT_FALSE(writer->append(Transfer{}).ok());
}

TEST(CaptureWriter, RefusesATransferThatNoReaderTakesAndGoesOn) {
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
    ASSERT_TRUE(writer.ok());
    const Bytes huge(300'000);
    Transfer transfer;
    transfer.endpoint = 0x81;
    transfer.data = huge;
    EXPECT_EQ(writer->append(transfer).error().code, ErrorCode::invalid_argument);
    transfer.data = ByteView(huge).first(262'144 - 64);
    EXPECT_TRUE(writer->append(transfer).ok());
    ASSERT_TRUE(writer->close().ok());
    const auto read = read_capture(disk.contents);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->accounts.stream_bytes, transfer.data.size());
}

TEST(CaptureWriter, AStepOfTheRealTimeClockMovesNoTimeStamp) {
    FakeDisk disk;
    auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
    ASSERT_TRUE(writer.ok());
    Transfer transfer;
    transfer.endpoint = 0x81;
    for (const std::int64_t step_ns : {0LL, 3'600'000'000'000LL, -3'600'000'000'000LL}) {
        transfer.time.monotonic_ns = made_start.monotonic_ns + 5;
        transfer.time.realtime_ns = made_start.realtime_ns + step_ns;
        ASSERT_TRUE(writer->append(transfer).ok());
    }
    ASSERT_TRUE(writer->close().ok());
    const auto read = read_capture(disk.contents);
    ASSERT_TRUE(read.ok());
    for (const KeptTransfer& kept : read->transfers) {
        EXPECT_EQ(kept.transfer.time.monotonic_ns, made_start.monotonic_ns + 5);
        EXPECT_EQ(kept.transfer.time.realtime_ns, made_start.realtime_ns + 5);
    }
}

class CaptureOnDisk : public testing::Test {
protected:
    CaptureOnDisk() {
        std::string name = (std::filesystem::temp_directory_path() / "gyrolog-capture-XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~CaptureOnDisk() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

TEST_F(CaptureOnDisk, IsNotOverwrittenUnlessTold) {
    const std::string path = folder_ / "a.pcapng";
    { std::ofstream(path) << "precious"; }
    const auto refused = create_append_file(path, IfExists::refuse);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(std::filesystem::file_size(path), 8U);
    auto file_beside = create_append_file(path, IfExists::replace);
    ASSERT_TRUE(file_beside.ok());
    auto writer = CaptureWriter::create(std::move(*file_beside), made_identity(), HostTime{});
    ASSERT_TRUE(writer.ok());
    ASSERT_TRUE(writer->sync().ok());
    EXPECT_EQ(std::filesystem::file_size(path), 8U);
    ASSERT_TRUE(writer->take_place().ok());
    ASSERT_TRUE(writer->close().ok());
    const auto file = open_input_file(path);
    ASSERT_TRUE(file.ok());
    EXPECT_EQ((*file)->size_bytes(), writer->bytes_written());
}

TEST_F(CaptureOnDisk, ReplacesALinkToNothing) {
    std::filesystem::create_symlink(folder_ / "elsewhere", folder_ / "a.pcapng");
    auto file = create_append_file(folder_ / "a.pcapng", IfExists::replace);
    ASSERT_TRUE(file.ok());
    ASSERT_TRUE((*file)->write(as_bytes("x")).ok());
    ASSERT_TRUE((*file)->take_place().ok());
    EXPECT_FALSE(std::filesystem::exists(folder_ / "elsewhere"));
    EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(folder_ / "a.pcapng")));
}

TEST_F(CaptureOnDisk, NamesTheFolderThatIsNotThere) {
    const auto refused = create_append_file(folder_ / "none" / "a.pcapng", IfExists::refuse);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::not_found);
    const auto unread = CaptureReader::open((folder_ / "none.pcapng").string());
    ASSERT_FALSE(unread.ok());
    EXPECT_EQ(unread.error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace gyrolog
