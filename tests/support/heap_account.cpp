#include "tests/support/heap_account.hpp"

#include <cstdlib>
#include <new>

#include <malloc.h>

namespace gyrolog {

std::atomic<std::size_t> bytes_now = 0;
std::atomic<std::size_t> bytes_most = 0;
std::atomic<std::size_t> allocations = 0;

}  // namespace gyrolog

namespace {

void release(void* memory) {
    gyrolog::bytes_now -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
    void* const memory = std::malloc(size);
    if (memory == nullptr) { throw std::bad_alloc(); }
    ++gyrolog::allocations;
    const std::size_t now = gyrolog::bytes_now += malloc_usable_size(memory);
    std::size_t most = gyrolog::bytes_most;
    while (now > most && !gyrolog::bytes_most.compare_exchange_weak(most, now)) {}
    return memory;
}

void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
