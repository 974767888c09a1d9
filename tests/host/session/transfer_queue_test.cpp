#include "host/session/transfer_queue.hpp"

#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/instrumented.hpp"

namespace gyrolog {
namespace {

using std::chrono::milliseconds;

Transfer stream_transfer(std::uint64_t id, ByteView data) {
    Transfer transfer;
    transfer.id = id;
    transfer.endpoint = 0x81;
    transfer.requested_bytes = 512;
    transfer.data = data;
    return transfer;
}

TEST(TransferQueue, ReturnsWhatWasPushedInOrder) {
    TransferQueue queue(1 << 16);
    for (std::uint64_t id = 0; id < 100; ++id) {
        const Bytes data(id, static_cast<std::uint8_t>(id));
        Transfer transfer = stream_transfer(id, data);
        transfer.status = -static_cast<int>(id);
        transfer.time = {static_cast<std::int64_t>(id), 7};
        ASSERT_TRUE(queue.push(transfer));
    }
    std::uint64_t next = 0;
    queue.pop(milliseconds(0)).for_each([&](const Transfer& transfer) {
        EXPECT_EQ(transfer.id, next);
        EXPECT_EQ(transfer.status, -static_cast<int>(next));
        EXPECT_EQ(transfer.time.monotonic_ns, static_cast<std::int64_t>(next));
        EXPECT_EQ(Bytes(transfer.data.begin(), transfer.data.end()),
                  Bytes(next, static_cast<std::uint8_t>(next)));
        ++next;
    });
    EXPECT_EQ(next, 100U);
}

TEST(TransferQueue, RefusesWhatDoesNotFitAndKeepsWhatItAccepted) {
    TransferQueue queue(1000);
    const Bytes data(300, 0x55);
    std::size_t accepted = 0;
    while (queue.push(stream_transfer(accepted, data))) { ++accepted; }
    EXPECT_GE(accepted, 2U);
    EXPECT_LE(accepted, 3U);
    EXPECT_LE(queue.high_water_bytes(), 1000U);
    std::size_t seen = 0;
    queue.pop(milliseconds(0)).for_each([&](const Transfer& transfer) {
        EXPECT_EQ(transfer.data.size(), 300U);
        ++seen;
    });
    EXPECT_EQ(seen, accepted);
    EXPECT_TRUE(queue.push(stream_transfer(9, data))) << "room again after the consumer took its batch";
}

TEST(TransferQueue, ClosedQueueGivesItsRestAndFinishes) {
    TransferQueue queue(1000);
    ASSERT_TRUE(queue.push(stream_transfer(1, {})));
    queue.close();
    EXPECT_FALSE(queue.push(stream_transfer(2, {})));
    EXPECT_FALSE(queue.finished());
    EXPECT_FALSE(queue.pop(milliseconds(1000)).empty());
    EXPECT_TRUE(queue.finished());
    EXPECT_TRUE(queue.pop(milliseconds(1000)).empty());
}

std::size_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t total_pages = 0;
    std::size_t resident_pages = 0;
    statm >> total_pages >> resident_pages;
    return resident_pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(TransferQueue, GivesBackWhatAStallHasFilled) {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "needs memory of which ThreadSanitizer keeps no shadow";
#endif
    constexpr std::size_t capacity = std::size_t{32} << 20U;
    TransferQueue queue(capacity);
    const Bytes data(16'384, 0x55);
    const std::size_t before = resident_bytes();
    for (int round = 0; round < 2; ++round) {
        std::uint64_t pushed = 0;
        while (queue.push(stream_transfer(pushed, data))) { ++pushed; }
        EXPECT_GT(resident_bytes(), before + capacity / 2);
        std::uint64_t seen = 0;
        queue.pop(milliseconds(0)).for_each([&](const Transfer& transfer) {
            EXPECT_EQ(transfer.id, seen++);
            EXPECT_EQ(transfer.data.back(), 0x55);
        });
        EXPECT_EQ(seen, pushed);
        EXPECT_TRUE(queue.pop(milliseconds(0)).empty());
        // AddressSanitizer keeps a shadow of an eighth of the memory.
        constexpr std::size_t shadow = GYROLOG_IS_INSTRUMENTED ? capacity / 8 : 0;
        EXPECT_LT(resident_bytes(), before + capacity / 8 + shadow);
    }
}

TEST(TransferQueue, LosesNothingBetweenTwoThreads) {
    constexpr std::uint64_t transfers = 200'000;
    TransferQueue queue(4096);
    std::thread producer([&] {
        const Bytes data(40, 1);
        for (std::uint64_t id = 0; id < transfers;) {
            if (queue.push(stream_transfer(id, data))) {
                ++id;
            } else {
                std::this_thread::yield();
            }
        }
        queue.close();
    });
    std::uint64_t next = 0;
    while (!queue.finished()) {
        queue.pop(milliseconds(100)).for_each([&](const Transfer& transfer) {
            ASSERT_EQ(transfer.id, next);
            ++next;
        });
    }
    producer.join();
    EXPECT_EQ(next, transfers);
}

}  // namespace
}  // namespace gyrolog
