#include "analysis/parallel/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <latch>
#include <new>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

TEST(ParallelFor, DoesEachPieceOnceOnAnyNumberOfThreads) {
    for (const std::size_t count : {0U, 1U, 2U, 7U, 1000U}) {
        for (const unsigned threads : {0U, 1U, 2U, 5U, 40U}) {
            std::vector<int> done(count);
            parallel_for(count, threads, [&](std::size_t i) { ++done.at(i); });
            EXPECT_EQ(std::ranges::count(done, 1), static_cast<std::ptrdiff_t>(count)) << threads;
        }
    }
}

TEST(ParallelFor, OnOneThreadIsALoopInOrderOnTheCallersThread) {
    const auto caller = std::this_thread::get_id();
    std::vector<std::size_t> order;
    parallel_for(5, 1, [&](std::size_t i) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        order.push_back(i);
    });
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

// Neither piece can end before the other has begun.
TEST(ParallelFor, RunsPiecesAtTheSameTime) {
    std::latch both(2);
    parallel_for(2, 2, [&](std::size_t) { both.arrive_and_wait(); });
    EXPECT_TRUE(both.try_wait());
}

TEST(ParallelFor, HandsOnWhatATaskThrows) {
    for (const unsigned threads : {1U, 4U}) {
        std::atomic<int> begun = 0;
        const auto fails = [&](std::size_t) {
            ++begun;
            throw std::bad_alloc();
        };
        EXPECT_THROW(parallel_for(1000, threads, fails), std::bad_alloc);
        EXPECT_LE(begun, static_cast<int>(threads));
    }
}

TEST(ParallelFor, RunsNoMoreThanItMay) {
    std::atomic<int> running = 0;
    std::atomic<int> most = 0;
    parallel_for(200, 3, [&](std::size_t) {
        const int now = ++running;
        for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {}
        std::this_thread::yield();
        --running;
    });
    EXPECT_LE(most, 3);
}

}  // namespace
}  // namespace gyrolog
