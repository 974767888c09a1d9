// The board without the board: the firmware's C core on a simulated MPU-9250, in simulated time.
//
// Time moves only in advance_to(); nothing here reads a clock or has a thread. The same options and the same
// calls at the same times give the same bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware_protocol/device/board.h"
#include "host/base/bytes.hpp"
#include "host/base/result.hpp"
#include "host/virtual_board/board_fault.hpp"
#include "host/virtual_board/in_endpoint.hpp"
#include "host/virtual_board/simulated_mpu9250.hpp"
#include "host/virtual_board/usb_descriptors.hpp"

namespace gyrolog {

struct VirtualBoardOptions {
    SensorModel model = typical_mpu9250();
    std::uint64_t seed = 1;
    std::string serial = "SIM0001";
    // Set at power-on by a CONFIGURE; a host may change them later as on any board. 0 leaves the firmware's
    // default.
    double rate_hz = 0.0;
    unsigned full_scale_dps = 0;
    unsigned dlpf_hz = 0;  // GLP_DLPF_OFF bypasses the filter
    // The sensor's clock against its nominal rate, and the microcontroller's against true time, both
    // relative. Without a value they are drawn from the seed: the sensor's with the model's sd_abs
    // "rate_rel", the other with 20 ppm.
    std::optional<double> sensor_clock_error;
    std::optional<double> tick_clock_error;
    std::uint32_t tick_hz = 1'000'000;
    std::uint8_t tick_bits = 32;
    std::uint64_t first_tick = 0;  // the tick counter at power-on
    std::uint32_t first_sequence = 0;
    std::uint32_t boot_id = 1;
    std::size_t ring_bytes = 4096;
    std::vector<BoardFault> faults;
    bool self_powered = false;  // keeps its memory while it is unplugged
    UsbEndpoints endpoints;
    std::uint8_t who_am_i = GLP_MPU_9250_ID;  // of the sensor
};

class VirtualBoard {
public:
    // Powers the board on. Error `invalid_argument` for a model that cannot be simulated or a configuration
    // that the sensor does not have.
    static Result<std::unique_ptr<VirtualBoard>> create(VirtualBoardOptions options);

    VirtualBoard(const VirtualBoard&) = delete;
    VirtualBoard& operator=(const VirtualBoard&) = delete;

    // --- Time: nanoseconds since power-on, as true as the host's.
    std::int64_t now_ns() const { return now_ns_; }
    void advance_to(std::int64_t time_ns);

    // --- The USB port.
    void on_line_state(bool data_terminal_ready);
    void on_receive(ByteView bytes);
    InEndpoint& in_endpoint() { return in_endpoint_; }
    bool unplugged() const { return unplugged_; }
    // When the cable is back; nothing when it was pulled for good.
    std::optional<std::int64_t> replug_ns() const { return replug_ns_; }
    // The cable is back, no earlier than replug_ns().
    void replug(std::int64_t time_ns);
    // When the firmware last put a byte on the wire.
    std::int64_t last_write_ns() const { return last_write_ns_; }

    // --- The end of a run of known length.
    // After this many sampling instants since the stream's last start the sensor stops firing. A board that
    // begins anew, by a reset or a cable that was pulled, goes on to the same end, by time.
    void set_sample_limit(std::optional<std::uint64_t> samples) { sample_limit_ = samples; }
    // The same by time at the nominal rate in force when the stream starts: one hour at 100 Hz is 360 000
    // samples, whatever the sensor's clock is off by.
    void set_duration_limit(std::optional<double> duration_s) { duration_limit_s_ = duration_s; }
    bool sample_limit_reached() const;
    // Sampling instants since the stream's last start.
    std::uint64_t sampling_instants() const { return sampling_instants_of(board_); }
    static std::uint64_t sampling_instants_of(const glp_board& firmware) {
        return firmware.next_index + (firmware.instants - firmware.instants_done);
    }
    bool streaming() const { return board_.streaming; }
    bool link_stalled() const { return now_ns_ < link_stalled_until_ns_; }
    // When the stream first started; nothing before.
    std::optional<std::int64_t> first_start_ns() const { return first_start_ns_; }
    // Lowers DTR and lets the firmware send what it still has. True once the ring is empty; until then call
    // again after the endpoint was read.
    bool finish();

    // --- Faults, at once.
    void fault(const BoardFault& fault);

    const SimulatedMpu9250& sensor() const { return sensor_; }
    const glp_board& firmware() const { return board_; }
    const std::string& serial() const { return options_.serial; }
    const UsbEndpoints& endpoints() const { return options_.endpoints; }

private:
    explicit VirtualBoard(VirtualBoardOptions options);

    Status power_on();
    Status configure_at_power_on();
    void run_main_loop();
    void note_start();
    void spend_limit();
    void begin_anew();
    void take_instant();
    void meet_faults();
    std::int64_t next_event_ns() const;
    std::uint64_t ticks() const;
    std::size_t link_write(ByteView bytes);
    static glp_hal make_hal(VirtualBoard* self);

    VirtualBoardOptions options_;
    double ticks_per_ns_;
    SimulatedMpu9250 sensor_;
    InEndpoint in_endpoint_;
    glp_hal hal_;
    glp_board board_{};
    std::vector<std::uint8_t> ring_;
    std::uint32_t boot_id_;

    std::int64_t now_ns_ = 0;
    std::int64_t last_poll_ns_ = 0;
    std::optional<std::int64_t> first_start_ns_;
    std::optional<std::uint64_t> sample_limit_;
    std::optional<double> duration_limit_s_;
    bool line_state_ = false;
    bool unplugged_ = false;
    std::optional<std::int64_t> replug_ns_;
    std::int64_t last_write_ns_ = 0;
    std::int64_t limit_from_ns_ = 0;  // what is left of the limit counts from here

    std::vector<BoardFault> due_;  // by time, the last one first
    std::int64_t main_loop_stalled_until_ns_ = 0;
    std::int64_t link_stalled_until_ns_ = 0;
    std::int64_t interrupt_lost_until_ns_ = 0;
    std::int64_t sensor_frozen_until_ns_ = 0;
    unsigned bus_errors_due_ = 0;
    std::size_t drop_bytes_due_ = 0;
    bool duplicate_due_ = false;
    bool corrupt_due_ = false;
};

}  // namespace gyrolog
