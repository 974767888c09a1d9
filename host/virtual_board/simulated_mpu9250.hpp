// An MPU-9250 behind its registers (RM-MPU-9250A-00): what a firmware writes, reads and is interrupted by.
//
// Its samples are those of SensorSimulator with the same model and seed, at the rate that is set:
//   when      A sample is there at its slot's time stamp, counted from the first one. The model's clock
//             effects and its timestamp_jitter_s act through the stamps. Instants keep their order and,
//             between slots that follow each other, a distance of 0.51 to 1.49 periods, so that no firmware
//             takes jitter for a lost interrupt.
//   lost      A slot that the model marks as lost brings no interrupt and nothing into the FIFO. The firmware
//             cannot count it: the next sample is flagged as a discontinuity of time, the host's accounts
//             miss nothing, and the recording has a hole by the ticks.
//   gyro      The counts are SensorSimulator's own, bit for bit, where the registers set the model's full
//             scale and the model's step is the register's to 0.1 % (files round it), but for an
//             effect's step that is no multiple of it. Otherwise the registers' step and range convert
//             the same rates.
//   accel     That of the model's accelerometer; of a model without one, the specific force in the sensor's
//             axes, with acc_noise_m_s2.
//   DLPF      A filter whose bandwidth lies below 0.4 of the output rate acts: it is SensorSimulator's
//             `lowpass` of the second order, behind the model's own. The register map gives bandwidths and
//             delays, and no order. The model's N holds at the output, at low frequencies: what folds there
//             behind the filter is not added. Filters that are wider leave the model's noise as it is.
//
// Simulated too: reset, sleep, identity, sample rate and divider, full scales, the 512-byte FIFO with both of
// its overflow modes, the data-ready interrupt and its status bits, the data registers, the die's
// temperature, and a sample clock that is off its nominal rate. Not simulated: self test, motion interrupts,
// the magnetometer, the time that a bus access takes.
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
#include "firmware_protocol/device/mpu9250.h"

namespace gyrolog {

class SimulatedMpu9250 {
public:
    static constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::max();
    static constexpr double clock_error_max = 0.01;  // PS-MPU-9250A-01, table 1: total rate variation
    // Of the output rate: a filter that is wider than this leaves the output as it is.
    static constexpr double widest_filter = 0.4;

    // `clock_error`: how much faster than nominal the chip's own clock runs, relative, within
    // clock_error_max.
    SimulatedMpu9250(const SensorModel& model, std::uint64_t seed, double clock_error,
                     std::uint8_t who_am_i = GLP_MPU_9250_ID);

    void write(std::uint8_t address, std::uint8_t value, std::int64_t now_ns);
    // One burst: the address counts up, except at FIFO_R_W.
    void read(std::uint8_t address, std::span<std::uint8_t> bytes);

    // The next sampling instant that anything waits for; never_ns when neither interrupt nor FIFO is on.
    std::int64_t next_instant_ns() const { return next_instant_ns_; }
    // Takes the sample of that instant; frozen, the one before once more. True when the interrupt pin pulses.
    bool pass_instant(bool frozen = false);

    // All registers and the FIFO as at power-on.
    void reset(std::int64_t now_ns);

    // Only each k-th sample is looked at (a port whose timer counts the interrupt pin): the others pass
    // unseen. 1 at reset. The FIFO must be off when k is not 1.
    void set_pin_divider(unsigned divider, std::int64_t now_ns);

    // The rate at which instants come by the registers, without the clock's error and with the pin divider.
    double nominal_rate_hz() const;
    double true_rate_hz() const { return nominal_rate_hz() * (1.0 + clock_error_); }

private:
    using Fields =
        std::array<std::int16_t, 7>;  // accel x y z, temperature, gyro x y z: the order of the registers

    // Of a sensor's filter, in Hz; 0 of one that does not act on the output.
    struct Bandwidths {
        double gyro_hz = 0.0;
        double accel_hz = 0.0;
        bool operator==(const Bandwidths&) const = default;
    };

    Bandwidths bandwidths() const;
    void restart_clock(std::int64_t now_ns);
    void schedule(std::int64_t after_ns);
    bool samples_wanted() const;
    void prepare_simulator();
    void go_to_next_slot();
    void next_block();
    void convert();
    std::int64_t stamp_ns() const;
    void put_in_fifo(std::uint8_t byte);
    void store_sample_in_fifo();
    std::uint8_t read_register(std::uint8_t address);

    SensorModel model_;
    std::uint64_t seed_;
    double clock_error_;
    std::uint8_t who_am_i_;

    std::array<std::uint8_t, 128> registers_{};
    Fields fields_{};
    unsigned pin_divider_ = 1;

    std::int64_t clock_start_ns_ = 0;  // of the grid on which a start finds its first instant
    double period_ns_ = 0.0;
    std::int64_t stamps_start_ns_ = 0;  // time 0 of the simulator's stamps
    std::int64_t next_instant_ns_ = never_ns;

    // Samples ahead of time, a block at once. A new rate or filter begins a new simulation.
    std::optional<SensorSimulator> simulator_;
    std::optional<SensorSimulator> accelerometer_;  // of a model that has one, or of its filtered noise
    const SampleBlock* accelerometer_block_ = nullptr;
    double simulated_rate_hz_ = 0.0;
    Bandwidths simulated_bandwidths_;
    std::uint64_t simulations_ = 0;
    const SampleBlock* block_ = nullptr;
    std::size_t place_ = block_samples;  // of the sample at next_instant_ns_
    std::array<Fields, block_samples> counts_{};

    std::array<std::uint8_t, 512> fifo_{};
    std::size_t fifo_begin_ = 0;
    std::size_t fifo_bytes_ = 0;
};

}  // namespace gyrolog
