// What an analysis of sensor counts takes of memory, by counting what is allocated.

#include <atomic>
#include <cstdlib>
#include <new>
#include <random>

#include <gtest/gtest.h>
#include <malloc.h>

#include "analysis/allan/allan_deviation.hpp"

namespace {

std::atomic<std::size_t> bytes_now = 0;
std::atomic<std::size_t> bytes_most = 0;

void release(void* memory) {
    bytes_now -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
    void* const memory = std::malloc(size);
    if (memory == nullptr) { throw std::bad_alloc(); }
    const std::size_t now = bytes_now += malloc_usable_size(memory);
    std::size_t most = bytes_most;
    while (now > most && !bytes_most.compare_exchange_weak(most, now)) {}
    return memory;
}

void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }

namespace gyrolog {
namespace {

TEST(AllanMemory, OfThreeAxesOfCountsStaysBelowTheSamplesAsDoubles) {
    constexpr std::size_t samples = 1'000'000;
    const std::size_t before = bytes_now;
    std::mt19937_64 random(1);
    std::vector<Column> axes;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<std::int16_t> counts(samples);
        for (auto& x : counts) { x = static_cast<std::int16_t>(random() % 64U); }
        axes.push_back({"gx", "rad/s", std::move(counts), 1.0, 0.0, "lsb"});
    }
    const std::vector<Segment> whole = {{0, samples, 0}};
    bytes_most = bytes_now.load();
    for (const Column& axis : axes) { EXPECT_GT(allan_deviation(axis, whole, 100.0).points.size(), 80U); }
    const std::size_t used = bytes_most - before;
    EXPECT_LT(used, 3 * samples * sizeof(double)) << used << " bytes";
    // Two bytes of counts for each axis, four of theta for one, and what does not grow with the record.
    EXPECT_LT(used, (3 * 2 + 4) * samples + 4'000'000) << used << " bytes";
}

}  // namespace
}  // namespace gyrolog
