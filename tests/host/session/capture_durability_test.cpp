// What reaches the disk, and when: this program's fdatasync notes its calls before it makes them.

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "host/session/capture_session.hpp"
#include "host/session/load_capture.hpp"
#include "tests/host/session/board_source.hpp"
#include "tests/support/program.hpp"

namespace {

struct SyncCall {
    std::int64_t at_ns = 0;
    std::uint64_t file_bytes = 0;
};

std::atomic<int> slow_ms = 0;  // a disk that takes its time
std::atomic<bool> broken = false;
std::mutex calls_mutex;
std::vector<SyncCall> calls;

}  // namespace

extern "C" int fdatasync(int descriptor) {
    struct stat file {};
    fstat(descriptor, &file);
    {
        const std::lock_guard lock(calls_mutex);
        calls.push_back({gyrolog::clock_ns(CLOCK_MONOTONIC), static_cast<std::uint64_t>(file.st_size)});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(slow_ms));
    if (broken) {
        errno = EIO;
        return -1;
    }
    return static_cast<int>(syscall(SYS_fdatasync, descriptor));
}

namespace gyrolog {
namespace {

TEST(CaptureDurability, FileIsSyncedEverySecondAndAtItsEnd) {
    const TemporaryFolder folder;
    CaptureRequest request;
    request.path = folder.path("run.pcapng");
    request.duration_s = 2.3;
    const auto source = BoardSource::create({.turn_board_s = 0.010, .turn_host_s = 0.010});
    {
        const std::lock_guard lock(calls_mutex);
        calls.clear();
    }
    std::int64_t last_ns = clock_ns(CLOCK_MONOTONIC);
    const auto outcome =
        run_capture(*source, request, [](const CaptureProgress& /*progress*/) { return true; });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    const std::lock_guard lock(calls_mutex);
    ASSERT_GE(calls.size(), 3U) << "two seconds and an end";
    std::uint64_t last_bytes = 0;
    for (const SyncCall& call : calls) {
        // The writer wakes ten times a second; the rest is a busy machine's.
        EXPECT_LT(call.at_ns - last_ns, 1'500'000'000);
        EXPECT_GT(call.file_bytes, last_bytes) << "what came since is in it";
        last_ns = call.at_ns;
        last_bytes = call.file_bytes;
    }
    EXPECT_EQ(last_bytes, std::filesystem::file_size(request.path)) << "all of it";
}

// What came is in the file while the disk still syncs what came before: a kill then costs no more than ever.
TEST(CaptureDurability, DiskThatSyncsForSecondsKeepsNothingFromBeingWritten) {
    const TemporaryFolder folder;
    CaptureRequest request;
    request.path = folder.path("run.pcapng");
    const auto source = BoardSource::create({.turn_board_s = 0.010, .turn_host_s = 0.010});
    slow_ms = 2000;
    std::uintmax_t bytes = 0;
    std::int64_t grown_ns = clock_ns(CLOCK_MONOTONIC);
    std::int64_t longest_ns = 0;
    const auto outcome = run_capture(*source, request, [&](const CaptureProgress& progress) {
        const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
        longest_ns = std::max(longest_ns, now_ns - grown_ns);
        const std::uintmax_t now_bytes = std::filesystem::file_size(request.path);
        if (now_bytes > bytes) { grown_ns = now_ns; }
        bytes = now_bytes;
        if (progress.elapsed_s > 2.5) { slow_ms = 0; }
        return progress.elapsed_s < 2.6;
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_LT(longest_ns, 900'000'000) << "it grows four times a second";
    EXPECT_FALSE(outcome->data_lost());
}

// What the disk says in its own time is not overheard.
TEST(CaptureDurability, FailedSyncEndsTheCaptureAndLeavesAReadableFile) {
    const TemporaryFolder folder;
    CaptureRequest request;
    request.path = folder.path("run.pcapng");
    const auto source = BoardSource::create({.turn_board_s = 0.010, .turn_host_s = 0.010});
    const auto outcome = run_capture(*source, request, [&](const CaptureProgress& progress) {
        broken = progress.elapsed_s > 0.3;
        return progress.elapsed_s < 10.0;
    });
    broken = false;
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::storage_failed);
    ASSERT_TRUE(outcome->error.has_value());
    EXPECT_EQ(outcome->error->code, ErrorCode::storage_failed);
    EXPECT_NE(outcome->error->message.find("sync '"), std::string::npos) << outcome->error->message;
    EXPECT_LT(outcome->progress.elapsed_s, 4.0) << "the first failure is told by the second's sync";
    const auto stored = load_capture(request.path, false);
    ASSERT_TRUE(stored.ok()) << stored.error().message;
    EXPECT_EQ(stored->file.blocks.end, FileEnd::clean);
    EXPECT_GT(stored->decoder->report().samples.good, 500U);
}

}  // namespace
}  // namespace gyrolog
