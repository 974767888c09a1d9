// An MPU-9250 behind its registers (RM-MPU-9250A-00): what a firmware writes, reads and is interrupted by.
//
// Simulated: reset, sleep, identity, sample rate and divider, full scales, the 512-byte FIFO with both of its
// overflow modes, the data-ready interrupt and its status bits, the data registers, the die's temperature,
// and a sample clock that is off its nominal rate. Not simulated: the filter's shape and delay (DLPF_CFG
// chooses the rate only; the model's noise density holds at the output rate that is set), self test, motion
// interrupts, the magnetometer, the time that a bus access takes.
//
// Time is handed in; the chip never reads a clock. Samples are drawn only while an interrupt or the FIFO
// wants them: what the chip gives after a start does not depend on how long it idled.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "analysis/simulate/sensor_model.hpp"
#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog {

class SimulatedMpu9250 {
public:
    static constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::max();
    static constexpr double clock_error_max = 0.01;  // PS-MPU-9250A-01, table 1: total rate variation

    // `clock_error`: how much faster than nominal the chip's own clock runs, relative, within
    // clock_error_max.
    SimulatedMpu9250(const SensorModel& model, std::uint64_t seed, double clock_error);

    void write(std::uint8_t address, std::uint8_t value, std::int64_t now_ns);
    // One burst: the address counts up, except at FIFO_R_W.
    void read(std::uint8_t address, std::span<std::uint8_t> bytes);

    // The next sampling instant that anything waits for; never_ns when neither interrupt nor FIFO is on.
    std::int64_t next_instant_ns() const { return next_instant_ns_; }
    // Takes the sample of that instant. True when the interrupt pin pulses.
    bool pass_instant();

    // Only each k-th sample is looked at (a port whose timer counts the interrupt pin): the others pass
    // unseen. 1 at reset. The FIFO must be off when k is not 1.
    void set_pin_divider(unsigned divider, std::int64_t now_ns);

    // The rate at which instants come by the registers, without the clock's error and with the pin divider.
    double nominal_rate_hz() const;
    double true_rate_hz() const { return nominal_rate_hz() * (1.0 + clock_error_); }

private:
    using Fields =
        std::array<std::int16_t, 7>;  // accel x y z, temperature, gyro x y z: the order of the registers

    void reset(std::int64_t now_ns);
    void restart_clock(std::int64_t now_ns);
    void schedule(std::int64_t after_ns);
    bool samples_wanted() const;
    void draw_sample();
    void refill();
    void put_in_fifo(std::uint8_t byte);
    void store_sample_in_fifo();
    std::uint8_t read_register(std::uint8_t address);

    SensorModel model_;
    std::uint64_t seed_;
    double clock_error_;

    std::array<std::uint8_t, 128> registers_{};
    Fields fields_{};
    unsigned pin_divider_ = 1;

    std::int64_t clock_start_ns_ = 0;  // of the grid of instants
    double period_ns_ = 0.0;
    std::int64_t instants_ = 0;  // index on the grid of next_instant_ns_
    std::int64_t next_instant_ns_ = never_ns;

    // Samples ahead of time, a block at once. A new rate begins a new simulation.
    std::optional<SensorSimulator> simulator_;
    double simulated_rate_hz_ = 0.0;
    std::uint64_t simulations_ = 0;
    const SampleBlock* block_ = nullptr;
    std::size_t place_ = block_samples;
    std::array<std::array<std::int16_t, 7>, block_samples> counts_{};

    std::array<std::uint8_t, 512> fifo_{};
    std::size_t fifo_begin_ = 0;
    std::size_t fifo_bytes_ = 0;
};

}  // namespace gyrolog
