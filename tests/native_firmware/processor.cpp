#include "tests/native_firmware/processor.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <sys/mman.h>

namespace gyrolog {
namespace {

constexpr std::uint32_t page_bytes = 4096;
// Addresses of registers on both parts (LPC55S69: 4xxxxxxx; LPC1769: 4xxxxxxx and 5xxxxxxx).
constexpr std::uintptr_t registers_begin = 0x40000000;
constexpr std::uintptr_t registers_end = 0x60000000;
constexpr std::uint64_t turn_max_us = 1000;

Processor* running = nullptr;

volatile std::uint32_t& word_at(std::uintptr_t address) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the part's addresses are this program's
    return *reinterpret_cast<volatile std::uint32_t*>(address);
}

// Memory at the registers' own addresses.
void map_page(std::uint32_t address) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    void* const wanted = reinterpret_cast<void*>(static_cast<std::uintptr_t>(address));
    void* const mapped = ::mmap(wanted, page_bytes, PROT_READ | PROT_WRITE,
                                MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0);
    // A second processor finds the page of the first.
    if (mapped == MAP_FAILED && errno != EEXIST) {
        throw std::runtime_error("map the registers at " + std::to_string(address) + ": " +
                                 std::strerror(errno));
    }
}

}  // namespace

Processor& the_processor() { return *running; }

Processor::Processor(std::uint64_t ticks_per_us) : ticks_per_us_(ticks_per_us), stack_(stack_bytes) {
    if (running != nullptr) { throw std::logic_error("a second processor for the same firmware"); }
    running = this;
}

Processor::~Processor() { running = nullptr; }

void Processor::add_registers(std::uint32_t base, std::uint32_t bytes, Registers& registers) {
    const std::uint32_t first = base & ~(page_bytes - 1U);
    for (std::uint32_t page = first; page < base + bytes; page += page_bytes) { map_page(page); }
    blocks_.push_back({base, bytes, &registers});
}

void Processor::watch_stores(std::uint32_t base, std::uint32_t bytes, StoreWatch watch) {
    watch_base_ = base;
    watch_bytes_ = bytes;
    watch_ = std::move(watch);
}

void Processor::complain(std::string what) {
    constexpr std::size_t enough = 20;
    if (complaints_.size() < enough) { complaints_.push_back(std::move(what)); }
}

// ---------------------------------------------------------------------------- in and out of the firmware

void Processor::start(void (*entry)()) {
    entry_ = entry;
    ::getcontext(&firmware_context_);
    firmware_context_.uc_stack.ss_sp = stack_.data();
    firmware_context_.uc_stack.ss_size = stack_.size();
    firmware_context_.uc_link = nullptr;
    ::makecontext(&firmware_context_, &Processor::enter, 0);
}

void Processor::enter() {
    running->entry_();
    // A firmware that gave up hangs; its interrupts are still served.
    for (;;) { running->wait(turn_max_us * running->ticks_per_us_); }
}

void Processor::run_until(std::uint64_t ticks) {
    stop_ticks_ = ticks;
    schedule();
    if (now_ticks_ >= ticks) { return; }
    inside_ = true;
    ::swapcontext(&outside_context_, &firmware_context_);
    inside_ = false;
}

void Processor::leave() { ::swapcontext(&firmware_context_, &outside_context_); }

// ---------------------------------------------------------------------------- time

void Processor::schedule() {
    next_ticks_ = stop_ticks_;
    for (const Surroundings* one : surroundings_) {
        next_ticks_ = std::min(next_ticks_, one->next_event_ticks());
    }
}

void Processor::pass_events() {
    while (now_ticks_ >= next_ticks_) {
        for (Surroundings* one : surroundings_) {
            if (one->next_event_ticks() <= now_ticks_) { one->pass_event(now_ticks_); }
        }
        interrupts_due_ = true;
        if (now_ticks_ >= stop_ticks_) { leave(); }
        schedule();
    }
}

void Processor::wait(std::uint64_t ticks) {
    finish_store();
    const std::uint64_t end = now_ticks_ + ticks;
    schedule();
    while (now_ticks_ < end) {
        now_ticks_ = std::max(now_ticks_, std::min(end, next_ticks_));
        pass_events();
        serve_interrupts();
    }
}

void Processor::end_turn() {
    finish_store();
    const std::uint64_t end = now_ticks_ + turn_max_us * ticks_per_us_;
    schedule();
    while (!worked_ && now_ticks_ < end) {
        now_ticks_ = std::max(now_ticks_, std::min(end, next_ticks_));
        pass_events();
        serve_interrupts();
    }
    worked_ = false;
}

// ---------------------------------------------------------------------------- interrupts

InterruptLine& Processor::line(int number) {
    const auto found = std::find_if(lines_.begin(), lines_.end(),
                                    [number](const InterruptLine& one) { return one.number == number; });
    if (found == lines_.end()) { throw std::logic_error("no interrupt " + std::to_string(number)); }
    return *found;
}

void Processor::interrupts_changed() {
    finish_store();
    interrupts_due_ = true;
    serve_interrupts();
}

void Processor::mask_interrupts(bool masked) {
    masked_ = masked;
    interrupts_changed();
}

void Processor::serve_interrupts() {
    while (interrupts_due_ && !masked_) {
        InterruptLine* urgent = nullptr;
        for (InterruptLine& one : lines_) {
            const bool wins = one.priority < (urgent != nullptr ? urgent->priority : priority_);
            if (one.enabled && wins && one.asks()) { urgent = &one; }
        }
        if (urgent == nullptr) {
            // What is kept waiting by a more urgent one is looked at again when that one ends.
            interrupts_due_ = false;
            return;
        }
        const unsigned before = std::exchange(priority_, urgent->priority);
        now_ticks_ += interrupt_ticks;
        urgent->handler();
        finish_store();
        priority_ = before;
        worked_ = true;
        interrupts_due_ = true;
    }
}

// ---------------------------------------------------------------------------- loads and stores

const Processor::Block* Processor::block_at(std::uintptr_t address) const {
    for (const Block& block : blocks_) {
        if (address - block.base < block.bytes) { return &block; }
    }
    return nullptr;
}

void Processor::finish_store() {
    if (stored_block_ != nullptr) {
        const Block& block = *std::exchange(stored_block_, nullptr);
        block.registers->write(stored_offset_, word_at(block.base + stored_offset_));
        interrupts_due_ = true;
        schedule();
    }
    if (watched_address_ != 0) {
        const std::uint32_t address = std::exchange(watched_address_, 0);
        watch_(address, watched_before_, word_at(address));
    }
}

void Processor::access(std::uintptr_t address, std::size_t bytes, bool store) {
    finish_store();
    now_ticks_ += access_ticks;
    if (now_ticks_ >= next_ticks_) { pass_events(); }
    if (interrupts_due_) { serve_interrupts(); }
    if (store && address - watch_base_ < watch_bytes_) {
        watched_address_ = static_cast<std::uint32_t>(address & ~std::uintptr_t{3});
        watched_before_ = word_at(watched_address_);
    }
    if (address < registers_begin || address >= registers_end) { return; }
    const Block* const block = block_at(address);
    if (block == nullptr) { return; }
    const auto offset = static_cast<std::uint32_t>(address - block->base);
    if (bytes != sizeof(std::uint32_t) || offset % sizeof(std::uint32_t) != 0) {
        throw std::logic_error("the firmware touches " + std::to_string(bytes) + " bytes at address " +
                               std::to_string(address) + ", where registers are words");
    }
    if (store) {
        stored_block_ = block;
        stored_offset_ = offset;
    } else {
        word_at(address) = block->registers->read(offset);
    }
}

}  // namespace gyrolog

// ---------------------------------------------------------------------------- called by the firmware's code

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the compiler's own names
extern "C" {

#define ACCESS(SIZE)                                                                          \
    void __tsan_read##SIZE(void* address);                                                    \
    void __tsan_write##SIZE(void* address);                                                   \
    void __tsan_unaligned_read##SIZE(void* address);                                          \
    void __tsan_unaligned_write##SIZE(void* address);                                         \
    void __tsan_volatile_read##SIZE(void* address);                                           \
    void __tsan_volatile_write##SIZE(void* address);                                          \
    void __tsan_unaligned_volatile_read##SIZE(void* address);                                 \
    void __tsan_unaligned_volatile_write##SIZE(void* address);                                \
    void __tsan_read##SIZE(void* address) { touch(address, SIZE, false); }                    \
    void __tsan_write##SIZE(void* address) { touch(address, SIZE, true); }                    \
    void __tsan_unaligned_read##SIZE(void* address) { touch(address, SIZE, false); }          \
    void __tsan_unaligned_write##SIZE(void* address) { touch(address, SIZE, true); }          \
    void __tsan_volatile_read##SIZE(void* address) { touch(address, SIZE, false); }           \
    void __tsan_volatile_write##SIZE(void* address) { touch(address, SIZE, true); }           \
    void __tsan_unaligned_volatile_read##SIZE(void* address) { touch(address, SIZE, false); } \
    void __tsan_unaligned_volatile_write##SIZE(void* address) { touch(address, SIZE, true); }

static void touch(void* address, std::size_t bytes, bool store) {
    gyrolog::the_processor().access(reinterpret_cast<std::uintptr_t>(address), bytes, store);
}

ACCESS(1)
ACCESS(2)
ACCESS(4)
ACCESS(8)
ACCESS(16)

void __tsan_read_range(void* address, std::size_t bytes);
void __tsan_write_range(void* address, std::size_t bytes);
void __tsan_init();
void __tsan_func_entry(void* caller);
void __tsan_func_exit();
void __tsan_read_range(void* address, std::size_t bytes) { touch(address, bytes, false); }
void __tsan_write_range(void* address, std::size_t bytes) { touch(address, bytes, true); }
void __tsan_init() {}
void __tsan_func_entry(void*) {}
void __tsan_func_exit() {}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
