// What reaches the disk, and when: this program's fdatasync notes its calls before it makes them.

#include <filesystem>
#include <mutex>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "host/session/capture_session.hpp"
#include "tests/host/session/board_source.hpp"
#include "tests/support/program.hpp"

namespace {

struct SyncCall {
    std::int64_t at_ns = 0;
    std::uint64_t file_bytes = 0;
};

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

}  // namespace
}  // namespace gyrolog
