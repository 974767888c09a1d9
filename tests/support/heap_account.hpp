// What a test program has allocated, now and at most. A program that links this counts every operator new.
#pragma once

#include <atomic>
#include <cstddef>

namespace gyrolog {

extern std::atomic<std::size_t> bytes_now;
extern std::atomic<std::size_t> bytes_most;
extern std::atomic<std::size_t> allocations;  // since the program began

}  // namespace gyrolog
