// What a night brings: a cable that is pulled, a disk that is full, slow or broken.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/simulate/sensor_model.hpp"
#include "host/capture/capture_reader.hpp"
#include "host/session/capture_session.hpp"
#include "host/session/load_capture.hpp"
#include "host/session/writer_thread.hpp"
#include "host/virtual_board/sim_source.hpp"
#include "tests/host/session/board_source.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using std::chrono::milliseconds;

bool go_on(const CaptureProgress& /*progress*/) { return true; }

// The computer's disk, but for what it is told to do wrong.
class FaultyDisk final : public Disk {
public:
    // Of every file made from now on, in the order of the calls.
    std::atomic<std::uint64_t> bytes_per_write{~std::uint64_t{0}};  // more is taken in part
    std::atomic<std::int64_t> write_takes_ms{0};
    std::atomic<std::int64_t> sync_takes_ms{0};  // once: the next sync
    std::atomic<std::uint64_t> room_bytes{~std::uint64_t{0}};
    std::atomic<bool> breaks{false};  // EIO at the next write
    std::atomic<bool> sync_breaks{false};
    std::atomic<std::uint64_t> told_free_bytes{~std::uint64_t{0}};
    std::atomic<int> files_with_room{std::numeric_limits<int>::max()};
    std::atomic<std::uint64_t> room_of_the_last_bytes{50'000};  // of these files
    std::atomic<int> syncs{0};
    std::atomic<std::uint64_t> written_bytes{0};

    struct Write {
        std::int64_t begun_ns = 0;
        std::int64_t done_ns = 0;
    };
    std::vector<Write> writes() const {
        const std::lock_guard lock(mutex_);
        return writes_;
    }

    Result<std::unique_ptr<AppendFile>> create(const std::string& path, IfExists if_exists) override {
        GYROLOG_TRY(std::unique_ptr<AppendFile> file, create_append_file(path, if_exists));
        if (--files_with_room == 0) { room_bytes = room_of_the_last_bytes.load(); }
        return std::unique_ptr<AppendFile>(new File(*this, std::move(file)));
    }
    Result<std::uint64_t> free_bytes(const std::string& /*path*/) override {
        return std::min(told_free_bytes.load(), room_bytes.load());
    }

private:
    class File final : public AppendFile {
    public:
        File(FaultyDisk& disk, std::unique_ptr<AppendFile> file) : disk_(disk), file_(std::move(file)) {}

        Result<std::size_t> write(ByteView bytes) override {
            const std::int64_t begun_ns = host_now().monotonic_ns;
            auto taken = write_slowly(bytes);
            const std::lock_guard lock(disk_.mutex_);
            disk_.writes_.push_back({begun_ns, host_now().monotonic_ns});
            return taken;
        }
        Result<std::size_t> write_slowly(ByteView bytes) {
            std::this_thread::sleep_for(milliseconds(disk_.write_takes_ms));
            if (disk_.breaks) { return Error{ErrorCode::storage_failed, "write: input/output error"}; }
            const std::uint64_t room = disk_.room_bytes;
            if (room == 0) { return Error{ErrorCode::disk_full, "write: no space left on device"}; }
            const auto size = static_cast<std::size_t>(
                std::min({std::uint64_t{bytes.size()}, room, disk_.bytes_per_write.load()}));
            if (room != ~std::uint64_t{0}) { disk_.room_bytes -= size; }
            disk_.written_bytes += size;
            return file_->write(bytes.first(size));
        }
        Status truncate(std::uint64_t size_bytes) override { return file_->truncate(size_bytes); }
        Status sync() override {
            ++disk_.syncs;
            std::this_thread::sleep_for(milliseconds(disk_.sync_takes_ms.exchange(0)));
            if (disk_.sync_breaks) { return Error{ErrorCode::storage_failed, "sync: input/output error"}; }
            return file_->sync();
        }
        Status close() override { return file_->close(); }

    private:
        FaultyDisk& disk_;
        std::unique_ptr<AppendFile> file_;
    };

    mutable std::mutex mutex_;
    std::vector<Write> writes_;
};

class CaptureOverFaults : public testing::Test {
protected:
    CaptureOverFaults() {
        request_.path = folder_.path("night.pcapng");
        request_.hello_timeout_s = 5.0;
        request_.duration_s = 3.0;
        request_.disk = &disk_;
        request_.on_unplug = OnUnplug::wait;
        request_.reconnect_interval_s = 0.02;
    }

    LoadedCapture loaded() const {
        auto capture = load_capture(request_.path, false);
        EXPECT_TRUE(capture.ok()) << (capture.ok() ? "" : capture.error().message);
        return capture.ok() ? std::move(capture).value() : LoadedCapture{};
    }
    // The files are whole, and hold every byte that the source delivered.
    void expect_all_stored(const BoardSource& source, const CaptureOutcome& outcome) const {
        const LoadedCapture stored = loaded();
        EXPECT_EQ(stored.file.blocks.end, FileEnd::clean);
        EXPECT_EQ(stored.file.stream_bytes, source.delivered().size());
        EXPECT_EQ(stored.decoder->report().samples.good, outcome.link.samples.good);
        EXPECT_EQ(outcome.transfers_dropped, 0U);
    }
    // The file is whole, though the disk refused to take all.
    void expect_readable_prefix(const BoardSource& source, const CaptureOutcome& outcome) const {
        EXPECT_EQ(outcome.end, CaptureEnd::storage_failed);
        ASSERT_TRUE(outcome.error.has_value());
        const LoadedCapture stored = loaded();
        EXPECT_EQ(stored.file.blocks.end, FileEnd::clean);
        EXPECT_LT(stored.file.stream_bytes, source.delivered().size());
        EXPECT_GT(stored.decoder->report().samples.good, 100U);
        EXPECT_EQ(stored.decoder->report().samples.missing, 0U);
    }

    TemporaryFolder folder_;
    FaultyDisk disk_;
    CaptureRequest request_;
};

// ------------------------------------------------------------------------------------- a board that is lost

std::unique_ptr<SimSource> simulated(std::vector<BoardFault> faults, bool self_powered, bool realtime) {
    SimOptions options;
    options.rate_hz = 1000.0;
    options.faults = std::move(faults);
    options.self_powered = self_powered;
    options.realtime = realtime;
    auto source = SimSource::create(options, typical_mpu9250(), {});
    EXPECT_TRUE(source.ok());
    return std::move(source).value();
}

TEST_F(CaptureOverFaults, BoardThatIsPulledTwiceIsTakenUpTwice) {
    for (const bool self_powered : {true, false}) {
        const auto source =
            simulated({{BoardFault::Kind::unplug, 5.0, 10.0}, {BoardFault::Kind::unplug, 25.0, 7.0}},
                      self_powered, false);
        request_.duration_s = 40.0;
        request_.overwrite = true;
        request_.configure.rate_mHz = 500'000;
        const auto outcome = run_capture(*source, request_, go_on);
        ASSERT_TRUE(outcome.ok()) << outcome.error().message;
        EXPECT_EQ(outcome->end, CaptureEnd::complete);
        EXPECT_EQ(outcome->progress.connections, 3U);
        EXPECT_TRUE(outcome->data_lost());
        ASSERT_EQ(outcome->paths.size(), 3U);
        EXPECT_EQ(outcome->link.boots, self_powered ? 1U : 3U);
        ASSERT_EQ(outcome->link.dropouts.size(), 2U);
        // 80 ms of samples may have waited in a frame, and a board boots in some 200 ms.
        EXPECT_NEAR(static_cast<double>(outcome->link.dropouts[0].samples), 10.0 * 500.0, 0.3 * 500.0);
        EXPECT_NEAR(static_cast<double>(outcome->link.dropouts[1].samples), 7.0 * 500.0, 0.3 * 500.0);
        EXPECT_EQ(outcome->progress.config->rate_mHz, 500'000U) << "set up again after it lost its memory";

        auto stored = load_capture(request_.path, true);
        ASSERT_TRUE(stored.ok());
        EXPECT_EQ(stored->files, outcome->paths);
        EXPECT_EQ(stored->decoder->report().samples.good, outcome->link.samples.good);
        EXPECT_EQ(stored->decoder->report().samples.missing, outcome->link.samples.missing);
        const auto recording = stored->decoder->take_recording("night");
        ASSERT_TRUE(recording.ok()) << recording.error().message;
        EXPECT_EQ(recording->segments.size(), 3U);
        EXPECT_EQ(recording->rows(), outcome->link.samples.good) << "one configuration: nothing is left out";
        for (const std::string& path : outcome->paths) { std::filesystem::remove(path); }
    }
}

TEST_F(CaptureOverFaults, WaitForALostBoardEndsWhenTheCallerWants) {
    const auto source = simulated({{BoardFault::Kind::unplug, 0.2, 1e6}}, false, true);
    request_.duration_s.reset();
    unsigned asked = 0;
    const auto outcome = run_capture(*source, request_, [&](const CaptureProgress& progress) {
        asked += progress.parked ? 1U : 0U;
        return asked < 3;
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::device_lost);
    EXPECT_EQ(asked, 3U);
    const LoadedCapture stored = loaded();
    ASSERT_TRUE(stored.last_checkpoint.has_value());
    EXPECT_TRUE(stored.last_checkpoint->last) << "the file was closed before the wait began";
}

TEST_F(CaptureOverFaults, WaitForALostBoardEndsWithTheDuration) {
    const auto source = simulated({{BoardFault::Kind::unplug, 0.2, 1e6}}, false, true);
    request_.duration_s = 0.7;
    const auto outcome = run_capture(*source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::device_lost);
    EXPECT_LT(outcome->progress.elapsed_s, 5.0);
}

TEST_F(CaptureOverFaults, LostBoardIsNotWaitedForInASpin) {
    const auto source = simulated({{BoardFault::Kind::unplug, 0.1, 1e6}}, false, true);
    request_.duration_s = 0.8;
    request_.reconnect_interval_s = 0.25;
    timespec before{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
    ASSERT_TRUE(run_capture(*source, request_, go_on).ok());
    timespec after{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
    const double cpu_s = static_cast<double>(after.tv_sec - before.tv_sec) +
                         static_cast<double>(after.tv_nsec - before.tv_nsec) * 1e-9;
    EXPECT_LT(cpu_s, 0.4) << "of 0.8 s";
}

// ------------------------------------------------------------------------------------------------- the disk

TEST_F(CaptureOverFaults, ShortWritesAreCarriedOn) {
    const auto source = BoardSource::create({});
    disk_.bytes_per_write = 1000;
    const auto outcome = run_capture(*source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_FALSE(outcome->data_lost());
    expect_all_stored(*source, *outcome);
}

TEST_F(CaptureOverFaults, SyncThatBlocksForLongIsRiddenOut) {
    // Twenty times faster than the clock: the queue meets in 0.8 s what a board at 20 kHz sends.
    const auto source = BoardSource::create({});
    disk_.sync_takes_ms = 800;
    request_.duration_s = 30.0;
    const auto outcome = run_capture(*source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_FALSE(outcome->data_lost());
    EXPECT_GT(outcome->queue_high_water_bytes, 100'000U) << "it did not block: this test tests nothing";
    EXPECT_EQ(source->bytes_refused(), 0U) << "the source never waits for the disk";
    expect_all_stored(*source, *outcome);
}

// What a kill would leave: the file as it is at this moment.
struct Snapshot {
    std::int64_t taken_ns = 0;
    std::string path;
};

// Of the transfers in the file the last one's arrival.
std::int64_t last_arrival_ns(const std::string& path) {
    auto reader = CaptureReader::open(path);
    if (!reader.ok()) { return 0; }
    std::int64_t last_ns = 0;
    while (true) {
        const auto captured = reader->next();
        if (!captured.ok() || !*captured) { return last_ns; }
        last_ns = (*captured)->transfer.time.monotonic_ns;
    }
}

// The promise of WriterThread, where each write takes longer than the interval between two.
TEST_F(CaptureOverFaults, WhatCameBeforeTheIntervalAndTheLastTwoWritesIsInTheFile) {
    constexpr double interval_s = std::chrono::duration<double>(WriterThread::flush_interval).count();
    constexpr double busy_machine_s = 0.1;
    const auto source = BoardSource::create({.turn_board_s = 0.005, .turn_host_s = 0.005});
    disk_.write_takes_ms = 350;
    request_.duration_s = 1.8;
    std::vector<Snapshot> snapshots;
    const auto outcome = run_capture(*source, request_, [&](const CaptureProgress& /*progress*/) {
        snapshots.push_back(
            {host_now().monotonic_ns, folder_.path("at" + std::to_string(snapshots.size()) + ".pcapng")});
        std::filesystem::copy_file(request_.path, snapshots.back().path);
        return true;
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_FALSE(outcome->data_lost());
    expect_all_stored(*source, *outcome);
    const std::vector<FaultyDisk::Write> writes = disk_.writes();
    unsigned under_load = 0;
    for (const Snapshot& snapshot : snapshots) {
        double allowed_s = interval_s + busy_machine_s;
        int counted = 0;
        for (auto write = writes.rbegin(); write != writes.rend() && counted < 2; ++write) {
            if (write->begun_ns > snapshot.taken_ns) { continue; }
            allowed_s +=
                static_cast<double>(std::min(write->done_ns, snapshot.taken_ns) - write->begun_ns) * 1e-9;
            ++counted;
        }
        const std::int64_t last_ns = last_arrival_ns(snapshot.path);
        if (last_ns == 0) { continue; }
        under_load += counted == 2 ? 1U : 0U;
        EXPECT_LE(static_cast<double>(snapshot.taken_ns - last_ns) * 1e-9, allowed_s);
    }
    EXPECT_GE(under_load, 5U) << "this test tests nothing";
}

// Many small writes would fall behind a disk that takes its time for each, however small.
TEST_F(CaptureOverFaults, ADiskThatIsSlowAtEveryWriteIsKeptUpWith) {
    // 8 kHz, nearly twenty times faster than the clock: some 2 MB/s.
    VirtualBoardOptions options;
    options.rate_hz = 8000.0;
    options.dlpf_hz = 250;
    const auto source = BoardSource::create({}, std::move(options));
    disk_.write_takes_ms = 200;
    request_.duration_s = 22.0;
    const auto outcome = run_capture(*source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_FALSE(outcome->data_lost());
    EXPECT_LT(outcome->queue_high_water_bytes, 1'000'000U) << "what comes during a write, and no more";
    expect_all_stored(*source, *outcome);
}

TEST_F(CaptureOverFaults, SlowDiskCostsCountedTransfersAndNothingElse) {
    const auto source = BoardSource::create({});
    disk_.write_takes_ms = 100;
    request_.queue_bytes = 20'000;
    request_.duration_s = 8.0;
    const auto outcome = run_capture(*source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_GT(outcome->bytes_dropped, 0U) << "the disk kept up: this test tests nothing";
    EXPECT_EQ(outcome->bytes_dropped, source->bytes_refused());
    EXPECT_TRUE(outcome->data_lost());
    const LoadedCapture stored = loaded();
    EXPECT_EQ(stored.file.stream_bytes, source->delivered().size());
    EXPECT_EQ(stored.decoder->report().samples.missing, outcome->link.samples.missing);
    EXPECT_EQ(outcome->link.samples.good + outcome->link.samples.missing,
              source->board().sampling_instants());
}

TEST_F(CaptureOverFaults, FullOrBrokenDiskEndsTheCaptureWithAReadableFile) {
    for (const int fault : {0, 1, 2}) {
        const auto source = BoardSource::create({});
        request_.duration_s = 600.0;
        request_.overwrite = true;
        disk_.room_bytes = fault == 0 ? 100'000 : ~std::uint64_t{0};
        disk_.written_bytes = 0;
        const auto outcome = run_capture(*source, request_, [&](const CaptureProgress& /*progress*/) {
            const bool enough = disk_.written_bytes > 50'000;
            if (fault == 1 && enough) { disk_.breaks = true; }
            if (fault == 2 && enough) { disk_.sync_breaks = true; }
            return true;
        });
        ASSERT_TRUE(outcome.ok()) << outcome.error().message;
        expect_readable_prefix(*source, *outcome);
        EXPECT_EQ(outcome->error->code, fault == 0 ? ErrorCode::disk_full : ErrorCode::storage_failed);
        EXPECT_LT(outcome->progress.elapsed_s, 20.0);
        disk_.breaks = disk_.sync_breaks = false;
    }
}

TEST_F(CaptureOverFaults, RoomThatIsToStayFreeEndsTheCaptureWithAClosedFile) {
    const auto source = BoardSource::create({});
    request_.duration_s = 600.0;
    request_.min_free_bytes = 1'000'000'000;
    disk_.told_free_bytes = 2'000'000'000;
    const auto outcome = run_capture(*source, request_, [&](const CaptureProgress& progress) {
        if (progress.samples > 5000) { disk_.told_free_bytes = 999'000'000; }
        return true;
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::storage_failed);
    ASSERT_TRUE(outcome->error.has_value());
    EXPECT_EQ(outcome->error->code, ErrorCode::disk_full);
    EXPECT_NE(outcome->error->message.find("999 MB left, and 1 GB are to stay free (--min-free)"),
              std::string::npos)
        << outcome->error->message;
    const LoadedCapture stored = loaded();
    EXPECT_EQ(stored.file.blocks.end, FileEnd::clean);
    ASSERT_TRUE(stored.last_checkpoint.has_value());
    EXPECT_TRUE(stored.last_checkpoint->last);
    EXPECT_GT(stored.decoder->report().samples.good, 5000U);

    request_.path = folder_.path("second.pcapng");
    const auto again = run_capture(*BoardSource::create({}), request_, go_on);
    ASSERT_FALSE(again.ok());
    EXPECT_EQ(again.error().code, ErrorCode::disk_full);
    EXPECT_FALSE(std::filesystem::exists(request_.path)) << "a full disk is not made fuller";
}

// Between two checkpoints a board that does not wait for the clock fills all of it.
TEST_F(CaptureOverFaults, RoomThatIsToStayFreeIsKeptAtFullSpeed) {
    const auto source = BoardSource::create({});
    request_.duration_s = 600.0;
    request_.min_free_bytes = 500'000;
    disk_.room_bytes = 1'000'000;
    const auto outcome = run_capture(*source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::storage_failed);
    ASSERT_TRUE(outcome->error.has_value());
    EXPECT_NE(outcome->error->message.find("--min-free"), std::string::npos) << outcome->error->message;
    constexpr std::uint64_t last_checkpoint_bytes = 2'000;
    EXPECT_GE(disk_.room_bytes, request_.min_free_bytes - last_checkpoint_bytes);
    EXPECT_LE(disk_.room_bytes, request_.min_free_bytes + 50'000) << "what may be used is used";
    EXPECT_EQ(loaded().file.blocks.end, FileEnd::clean);
}

TEST_F(CaptureOverFaults, DiskThatRefusesTheNextFileLeavesTheOnesBefore) {
    const auto source = BoardSource::create({});
    request_.duration_s = 600.0;
    request_.rotate_bytes = 100'000;
    disk_.files_with_room = 3;
    const auto outcome = run_capture(*source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    expect_readable_prefix(*source, *outcome);
    EXPECT_GE(outcome->paths.size(), 3U);
}

// Where not even the head of a file finds room.
TEST_F(CaptureOverFaults, FullDiskLeavesNoEmptyFile) {
    disk_.room_bytes = 100;
    const auto refused = run_capture(*BoardSource::create({}), request_, go_on);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::disk_full);
    EXPECT_FALSE(std::filesystem::exists(request_.path));

    disk_.room_bytes = ~std::uint64_t{0};
    disk_.files_with_room = 3;
    disk_.room_of_the_last_bytes = 100;
    request_.duration_s = 600.0;
    request_.rotate_bytes = 100'000;
    const auto outcome = run_capture(*BoardSource::create({}), request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::storage_failed);
    EXPECT_EQ(outcome->paths.size(), 2U);
    EXPECT_FALSE(std::filesystem::exists(folder_.path("night.3.pcapng")));
}

TEST_F(CaptureOverFaults, FilesThatAreThereAreSteppedOverNotOverwritten) {
    const std::string precious = folder_.path("night.2.pcapng");
    ASSERT_TRUE(run_capture(
                    *BoardSource::create({}),
                    [&] {
                        CaptureRequest other = request_;
                        other.path = precious;
                        return other;
                    }(),
                    go_on)
                    .ok());
    const std::string before = read_whole_file(precious);
    const auto source = BoardSource::create({});
    request_.duration_s = 8.0;
    request_.rotate_bytes = 60'000;
    request_.overwrite = true;
    const auto outcome = run_capture(*source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_GE(outcome->paths.size(), 3U);
    EXPECT_EQ(outcome->paths[1], folder_.path("night.3.pcapng"));
    EXPECT_EQ(read_whole_file(precious), before);
    expect_all_stored(*source, *outcome);
}

// ------------------------------------------------------------------------------------------ the host's clock

// A board in simulated time, on a computer whose real-time clock is set while the stream runs: by an hour
// back, by two hours forward, and by the second that a leap second is told twice.
class SetClockSource final : public ByteSource, private TransferSink {
public:
    explicit SetClockSource(std::unique_ptr<SimSource> board) : board_(std::move(board)) {}

    const SourceIdentity& identity() const override { return board_->identity(); }
    bool can_wait() const override { return true; }
    double tolerated_stall_s(double rate, double frame) const override {
        return board_->tolerated_stall_s(rate, frame);
    }
    Status start(TransferSink& sink) override {
        sink_ = &sink;
        return board_->start(*this);
    }
    Status set_line_state(bool raised) override { return board_->set_line_state(raised); }
    Status write(ByteView bytes) override { return board_->write(bytes); }
    void stop() override { board_->stop(); }

    const std::vector<std::int64_t>& monotonic_ns() const { return monotonic_ns_; }

private:
    bool on_transfer(const Transfer& transfer) override {
        constexpr std::int64_t hour_ns = 3'600'000'000'000;
        constexpr std::array<std::int64_t, 4> set_by_ns{0, -hour_ns, hour_ns, hour_ns - 1'000'000'000};
        Transfer told = transfer;
        told.time.realtime_ns += set_by_ns[(transfers_ / 20) % set_by_ns.size()];
        if (!sink_->on_transfer(told)) { return false; }
        ++transfers_;
        monotonic_ns_.push_back(told.time.monotonic_ns);
        return true;
    }
    void on_end(SourceEnd end, const std::optional<Error>& error) override { sink_->on_end(end, error); }

    std::unique_ptr<SimSource> board_;
    TransferSink* sink_ = nullptr;
    std::uint64_t transfers_ = 0;
    std::vector<std::int64_t> monotonic_ns_;
};

TEST_F(CaptureOverFaults, ClockThatIsSetMeanwhileMovesNoTimeStampAndNoRate) {
    SimOptions options;
    options.rate_hz = 1000.0;
    auto board = SimSource::create(options, typical_mpu9250(), {.samples = {}, .duration_s = 120.0});
    ASSERT_TRUE(board.ok());
    SetClockSource source(std::move(board).value());
    request_.duration_s.reset();
    const auto outcome = run_capture(source, request_, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_FALSE(outcome->data_lost());

    auto reader = CaptureReader::open(request_.path);
    ASSERT_TRUE(reader.ok());
    std::vector<std::int64_t> stored_ns;
    while (true) {
        const auto captured = reader->next();
        ASSERT_TRUE(captured.ok());
        if (!*captured) { break; }
        stored_ns.push_back((*captured)->transfer.time.monotonic_ns);
    }
    EXPECT_GT(stored_ns.size(), 80U) << "the clock was never set: this test tests nothing";
    EXPECT_EQ(stored_ns, source.monotonic_ns());

    auto stored = load_capture(request_.path, true);
    ASSERT_TRUE(stored.ok());
    EXPECT_TRUE(stored->decoder->report().complete());
    const auto fit = stored->decoder->timeline().host_clock();
    ASSERT_TRUE(fit.has_value());
    // The board's crystal is off by some 20 ppm; an hour within two minutes would be a factor of 30.
    EXPECT_NEAR(fit->ratio, 1.0, 100e-6 + 4.0 * fit->ratio_sd);
    const auto rate = stored->decoder->rate_estimate();
    ASSERT_TRUE(rate.has_value());
    EXPECT_NEAR(rate->rate_hz, 1000.0, 0.1);
    EXPECT_LT(rate->sd_hz, 1e-3);
    EXPECT_LT(rate->jitter_s, 10e-6);
    const auto recording = stored->decoder->take_recording("night");
    ASSERT_TRUE(recording.ok());
    EXPECT_EQ(recording->segments.size(), 1U);
    EXPECT_TRUE(recording->dropouts.empty());
}

}  // namespace
}  // namespace gyrolog
