// Runs a port's own code, compiled for this machine, as the processor of its part would: in simulated time,
// with the part's registers behind its loads and stores, and with interrupts between them.
//
// How an access is seen: the firmware is compiled with -fsanitize=thread and linked without that sanitizer,
// so that the compiler puts a call in front of each load and store, and those calls come here. Before a load
// of a register its value is put into the memory that stands for it; what a store has left there is handed on
// with the next call, before anything else happens.
//
// Assumed: each access takes access_ticks, which stands for the instructions around it. Where the firmware
// waits, the port's parts for the host say so and time jumps. The order of events is exact, the processor's
// speed is a guess.
//
// One at a time: the firmware's variables are those of the program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <ucontext.h>

namespace gyrolog {

// Of a register.
constexpr std::uint32_t bit(unsigned number) { return std::uint32_t{1} << number; }

constexpr std::uint64_t never_ticks = std::numeric_limits<std::uint64_t>::max();

struct MemoryRange {
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
};

// A block of the part's address map.
class Registers {
public:
    virtual ~Registers() = default;
    virtual std::uint32_t read(std::uint32_t offset) = 0;
    virtual void write(std::uint32_t offset, std::uint32_t value) = 0;
};

// What goes on beside the processor.
class Surroundings {
public:
    virtual ~Surroundings() = default;
    virtual std::uint64_t next_event_ticks() const = 0;
    virtual void pass_event(std::uint64_t now_ticks) = 0;
};

struct InterruptLine {
    int number = 0;
    std::function<bool()> asks;
    std::function<void()> handler;
    unsigned priority = 0;  // less is more urgent
    bool enabled = false;
};

class Processor {
public:
    static constexpr std::uint64_t access_ticks = 3;
    static constexpr std::uint64_t interrupt_ticks = 24;  // to the handler and back
    static constexpr std::size_t stack_bytes = 1U << 18U;

    // `ticks_per_us`: of the part's core. Maps the registers' pages as they are touched first.
    explicit Processor(std::uint64_t ticks_per_us);
    ~Processor();
    Processor(const Processor&) = delete;
    Processor& operator=(const Processor&) = delete;

    void add_registers(std::uint32_t base, std::uint32_t bytes, Registers& registers);
    void add_surroundings(Surroundings& surroundings) { surroundings_.push_back(&surroundings); }
    void add_interrupt(InterruptLine line) { lines_.push_back(std::move(line)); }
    // Told of each store to the firmware's memory from `base` on, `bytes` long: the word before and after.
    using StoreWatch = std::function<void(std::uint32_t address, std::uint32_t before, std::uint32_t after)>;
    void watch_stores(std::uint32_t base, std::uint32_t bytes, StoreWatch watch);

    std::uint64_t now_ticks() const { return now_ticks_; }
    std::uint64_t ticks_per_us() const { return ticks_per_us_; }
    std::int64_t to_ns(std::uint64_t ticks) const {
        return static_cast<std::int64_t>(ticks * 1000U / ticks_per_us_);
    }
    std::uint64_t from_ns(std::int64_t time_ns) const {
        return (static_cast<std::uint64_t>(time_ns) * ticks_per_us_ + 999U) / 1000U;
    }

    // Power-on: `entry` begins with the next run_until.
    void start(void (*entry)());
    void run_until(std::uint64_t ticks);

    // What the part forbids, as it was met. A test expects none.
    void complain(std::string what);
    const std::vector<std::string>& complaints() const { return complaints_; }

    // --- For the firmware's side.
    void access(std::uintptr_t address, std::size_t bytes, bool store);
    // The firmware does nothing else for so long.
    void wait(std::uint64_t ticks);
    // A turn of the main loop is over. After one in which nothing happened, nothing will until the next
    // event: time jumps there, or turn_max.
    void end_turn();
    void note_work() { worked_ = true; }
    // To be called where what goes on beside the processor has another next event than before.
    void schedule();
    InterruptLine& line(int number);
    void interrupts_changed();
    void mask_interrupts(bool masked);
    bool interrupts_masked() const { return masked_; }

private:
    struct Block {
        std::uint32_t base;
        std::uint32_t bytes;
        Registers* registers;
    };

    const Block* block_at(std::uintptr_t address) const;
    void finish_store();
    void pass_events();
    void serve_interrupts();
    void leave();
    static void enter();

    std::uint64_t ticks_per_us_;
    std::vector<Block> blocks_;
    std::vector<Surroundings*> surroundings_;
    std::vector<InterruptLine> lines_;
    std::vector<std::string> complaints_;

    std::uint64_t now_ticks_ = 0;
    std::uint64_t next_ticks_ = 0;  // of the next event, or stop_ticks_
    std::uint64_t stop_ticks_ = 0;
    bool interrupts_due_ = false;
    bool masked_ = false;
    unsigned priority_ = std::numeric_limits<unsigned>::max();  // of what runs
    bool worked_ = false;

    const Block* stored_block_ = nullptr;  // a store that has not been handed on
    std::uint32_t stored_offset_ = 0;
    std::uint32_t watch_base_ = 0;
    std::uint32_t watch_bytes_ = 0;
    StoreWatch watch_;
    std::uint32_t watched_address_ = 0;  // 0: none
    std::uint32_t watched_before_ = 0;

    void (*entry_)() = nullptr;
    bool inside_ = false;
    std::vector<std::byte> stack_;
    ucontext_t outside_context_{};
    ucontext_t firmware_context_{};
};

// The processor that the firmware of this program runs on; there is one at a time.
Processor& the_processor();

}  // namespace gyrolog
