#include "tests/native_firmware/native_board.hpp"

#include <algorithm>
#include <stdexcept>

#include "firmware_protocol/device/mpu9250.h"

extern "C" {
void run();
extern glp_board firmware_board;  // main.c's own, made visible
// By the linker script: the firmware's variables.
extern std::uint8_t firmware_memory_begin[];
extern std::uint8_t firmware_memory_end[];
}

namespace gyrolog {
namespace {

constexpr int capture_interrupt =
    -1;  // behind the port's sample_timer.h: no line of the interrupt controller
constexpr std::uint8_t read_bit = 0x80;
constexpr std::uint64_t slow_byte_us = 8;         // 1 MHz
constexpr std::uint64_t fast_bytes_per_2_us = 3;  // 12 MHz

NativeBoard* powered = nullptr;

void restore_variables() {
    static const std::vector<std::uint8_t> at_power_on(firmware_memory_begin, firmware_memory_end);
    std::copy(at_power_on.begin(), at_power_on.end(), firmware_memory_begin);
}

MemoryRange variables() {
    return {reinterpret_cast<std::uintptr_t>(firmware_memory_begin),
            reinterpret_cast<std::uintptr_t>(firmware_memory_end)};
}

}  // namespace

NativeBoard& the_board() { return *powered; }

NativeBoard::NativeBoard(const NativeBoardOptions& options)
    : options_(options),
      processor_(part_ticks_per_us),
      part_(make_part(processor_, variables())),
      sensor_(typical_mpu9250(), options.seed, options.sensor_clock_error) {
    restore_variables();
    powered = this;
    processor_.add_surroundings(*this);
    set_spi_fast(false);
    processor_.start(::run);
}

NativeBoard::~NativeBoard() { powered = nullptr; }

const glp_board& NativeBoard::firmware() const { return firmware_board; }

// ---------------------------------------------------------------------------- the data-ready line

void NativeBoard::capture_edges(void (*on_edge)(std::uint32_t ticks)) {
    on_edge_ = on_edge;
    InterruptLine line;
    line.number = capture_interrupt;
    line.enabled = true;
    line.asks = [this] { return captured_; };
    line.handler = [this] {
        captured_ = false;
        on_edge_(capture_ticks_);
    };
    processor_.add_interrupt(std::move(line));
}

std::uint64_t NativeBoard::next_event_ticks() const {
    const std::int64_t next_ns = sensor_.next_instant_ns();
    return next_ns == SimulatedMpu9250::never_ns ? never_ticks : processor_.from_ns(next_ns);
}

// An edge before the last one was served overwrites its capture, as in the part.
void NativeBoard::pass_event(std::uint64_t) {
    const std::uint64_t at_ticks = next_event_ticks();
    if (!sensor_.pass_instant()) { return; }
    edges_ticks_.push_back(at_ticks);
    captured_ = on_edge_ != nullptr;
    capture_ticks_ = static_cast<std::uint32_t>(at_ticks);
}

// ---------------------------------------------------------------------------- the sensor's bus

void NativeBoard::set_spi_fast(bool fast) {
    spi_byte_ticks_ = fast ? 2 * part_ticks_per_us / fast_bytes_per_2_us : slow_byte_us * part_ticks_per_us;
}

void NativeBoard::restart_spi() {
    spi_.clear();
    set_spi_fast(false);
}

void NativeBoard::select_sensor(bool selected) {
    selected_ = selected;
    addressed_ = false;
}

bool NativeBoard::spi_put(std::uint8_t byte) {
    if (spi_.size() == spi_entries) { return false; }
    processor_.note_work();
    const std::uint64_t begin = spi_.empty() ? processor_.now_ticks() : spi_.back().done_ticks;
    spi_.push_back({byte, std::max(begin, processor_.now_ticks()) + spi_byte_ticks_});
    return true;
}

// The firmware does nothing but ask again: time goes on to where the answer is there.
bool NativeBoard::spi_get(std::uint8_t& byte) {
    if (spi_.empty()) { return false; }
    const std::uint64_t done_ticks = spi_.front().done_ticks;
    if (done_ticks > processor_.now_ticks()) { processor_.wait(done_ticks - processor_.now_ticks()); }
    byte = exchange(spi_.front().out);
    spi_.erase(spi_.begin());
    return true;
}

// What the sensor sends while it takes `byte`.
std::uint8_t NativeBoard::exchange(std::uint8_t byte) {
    if (!selected_) { return 0xFF; }
    if (!addressed_) {
        addressed_ = true;
        reads_ = (byte & read_bit) != 0;
        address_ = byte & static_cast<std::uint8_t>(~read_bit);
        return 0;
    }
    std::uint8_t answer = 0;
    if (reads_) {
        sensor_.read(address_, {&answer, 1});
    } else {
        sensor_.write(address_, byte, processor_.to_ns(processor_.now_ticks()));
        processor_.schedule();
    }
    if (address_ != glp_mpu_fifo_r_w) { ++address_; }
    return answer;
}

}  // namespace gyrolog
