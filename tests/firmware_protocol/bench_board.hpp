// A board on the bench: glp_board over a small MPU-9250 and a USB endpoint that a test can fill, starve or
// break.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "firmware_protocol/device/board.h"

namespace gyrolog {

// The registers, the FIFO and the data-ready interrupt, as far as board.c uses them. Sample n has gyro x = n,
// the other fields of a constant pattern, so that a test can tell from a sample which one it is.
class BenchSensor {
public:
    BenchSensor() { reset(); }

    void reset() {
        registers.fill(0);
        registers[glp_mpu_who_am_i] = who_am_i;
        registers[glp_mpu_pwr_mgmt_1] = 0x01;
        fifo.clear();
    }

    bool write(std::uint8_t address, std::uint8_t value) {
        if (bus_broken) { return false; }
        writes.push_back({address, value});
        if (address == glp_mpu_pwr_mgmt_1 && (value & glp_mpu_pwr_mgmt_1_h_reset) != 0) {
            reset();
            return true;
        }
        if (address == glp_mpu_user_ctrl && (value & glp_mpu_user_ctrl_fifo_rst) != 0) {
            fifo.clear();
            value = static_cast<std::uint8_t>(value & ~glp_mpu_user_ctrl_fifo_rst);
        }
        registers[address] = static_cast<std::uint8_t>(value | stuck_bits[address]);
        return true;
    }

    bool read(std::uint8_t address, std::uint8_t* bytes, std::size_t size) {
        if (bus_broken ||
            (address == glp_mpu_fifo_r_w && fifo_reads_to_fail > 0 && fifo_reads_to_fail-- > 0)) {
            return false;
        }
        for (std::size_t i = 0; i < size; ++i) { bytes[i] = read_one(address, i); }
        return true;
    }

    // One sample inside the sensor. True when the interrupt pin pulses.
    bool sample() {
        const std::uint16_t fields[7] = {0x1111,
                                         0x2222,
                                         0x3333,
                                         temperature,
                                         static_cast<std::uint16_t>(next),
                                         static_cast<std::uint16_t>(next >> 16U),
                                         gyro_z};
        ++next;
        for (std::size_t i = 0; i < 7; ++i) {
            registers[glp_mpu_accel_xout_h + 2 * i] = static_cast<std::uint8_t>(fields[i] >> 8U);
            registers[glp_mpu_accel_xout_h + 2 * i + 1] = static_cast<std::uint8_t>(fields[i]);
        }
        const std::uint8_t parts = registers[glp_mpu_fifo_en];
        if ((registers[glp_mpu_user_ctrl] & glp_mpu_user_ctrl_fifo_en) != 0) {
            if ((parts & glp_mpu_fifo_en_accel) != 0) { push(glp_mpu_accel_xout_h, 6); }
            if ((parts & glp_mpu_fifo_en_temp) != 0) { push(glp_mpu_temp_out_h, 2); }
            if ((parts & glp_mpu_fifo_en_gyro) == glp_mpu_fifo_en_gyro) { push(glp_mpu_gyro_xout_h, 6); }
        }
        return !int_line_broken && (registers[glp_mpu_int_enable] & glp_mpu_int_raw_rdy) != 0;
    }

    std::uint8_t who_am_i = GLP_MPU_9250_ID;
    std::array<std::uint8_t, 128> registers{};
    std::array<std::uint8_t, 128> stuck_bits{};
    std::deque<std::uint8_t> fifo;
    std::vector<std::pair<std::uint8_t, std::uint8_t>> writes;
    bool bus_broken = false;
    bool int_line_broken = false;
    int fifo_reads_to_fail = 0;
    std::uint32_t next = 0;
    std::uint16_t temperature = 0x0102;
    std::uint16_t gyro_z = 0x0003;

private:
    std::uint8_t read_one(std::uint8_t address, std::size_t offset) {
        if (address == glp_mpu_fifo_r_w) {
            if (fifo.empty()) { return 0xFF; }
            const std::uint8_t byte = fifo.front();
            fifo.pop_front();
            return byte;
        }
        const std::size_t at = address + offset;
        if (at == glp_mpu_fifo_counth) { return static_cast<std::uint8_t>(fifo.size() >> 8U); }
        if (at == glp_mpu_fifo_counth + 1) { return static_cast<std::uint8_t>(fifo.size()); }
        const std::uint8_t byte = registers[at];
        if (at == glp_mpu_int_status) { registers[at] = 0; }
        return byte;
    }

    void push(std::size_t address, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) {
            if (fifo.size() == GLP_MPU_FIFO_BYTES) {
                registers[glp_mpu_int_status] |= glp_mpu_int_fifo_oflow;
                return;
            }
            fifo.push_back(registers[address + i]);
        }
    }
};

// A frame as the host keeps it.
struct ReceivedFrame {
    std::uint8_t type;
    std::uint16_t flags;
    std::uint32_t sequence;
    std::vector<std::uint8_t> payload;

    glp_frame view() const { return {type, flags, sequence, payload.data(), payload.size()}; }
    glp_samples samples() const {
        glp_samples samples{};
        const glp_frame frame = view();
        if (glp_samples_read(&frame, &samples) != glp_status_ok) { samples.count = 0; }
        return samples;
    }
    glp_event event() const {
        glp_event event{};
        const glp_frame frame = view();
        if (glp_event_read(&frame, &event) != glp_status_ok) { event.code = 0; }
        return event;
    }
};

class BenchBoard {
public:
    explicit BenchBoard(std::size_t ring_bytes = 4096, std::uint8_t tick_bits = 64) : ring_(ring_bytes) {
        hal_.context = this;
        hal_.sensor_on_spi = true;
        hal_.ticks = [](void* self) { return static_cast<BenchBoard*>(self)->read_ticks(); };
        hal_.sensor_write = [](void* self, std::uint8_t address, std::uint8_t value) {
            return static_cast<BenchBoard*>(self)->sensor.write(address, value);
        };
        hal_.sensor_read = [](void* self, std::uint8_t address, std::uint8_t* bytes, std::size_t size) {
            return static_cast<BenchBoard*>(self)->sensor.read(address, bytes, size);
        };
        hal_.delay_ms = [](void* self, std::uint32_t ms) {
            static_cast<BenchBoard*>(self)->ticks += ms * std::uint64_t{1000};
        };
        hal_.link_write = [](void* self, const std::uint8_t* bytes, std::size_t size) {
            return static_cast<BenchBoard*>(self)->accept(bytes, size);
        };
        hal_.link_flush = [](void* self) { ++static_cast<BenchBoard*>(self)->flushes; };
        hal_.usb_frame_number = nullptr;
        identity_.uid[0] = 0x5A;
        identity_.firmware = "bench";
        identity_.tick_hz = 1'000'000;
        identity_.tick_bits = tick_bits;
        identity_.boot_id = 77;
        identity_.reset_cause = glp_reset_power_on;
        glp_stream_init(&stream_);
        initialised = glp_board_init(&board, &hal_, &identity_, ring_.data(), ring_.size());
    }
    BenchBoard(const BenchBoard&) = delete;
    BenchBoard& operator=(const BenchBoard&) = delete;

    void boot_and_raise_dtr() {
        glp_board_boot(&board);
        glp_board_on_line_state(&board, true);
        glp_board_poll(&board);
    }

    // `count` samples of the sensor, a turn of the main loop after each unless the loop is stuck.
    void run(std::uint32_t count, bool loop_runs = true) {
        for (std::uint32_t i = 0; i < count; ++i) {
            ticks += sample_period_us;
            if (sensor.sample()) { glp_board_on_data_ready(&board, ticks); }
            if (loop_runs) { glp_board_poll(&board); }
        }
    }

    void command(std::uint8_t type, const std::vector<std::uint8_t>& payload = {}) {
        const glp_frame frame{type, 0, ++command_sequence, payload.data(), payload.size()};
        std::array<std::uint8_t, GLP_FRAME_WIRE_MAX> bytes{};
        const glp_cobs_result encoded = glp_frame_encode(&frame, bytes.data(), bytes.size());
        glp_board_on_receive(&board, bytes.data(), encoded.size);
        glp_board_poll(&board);
    }

    void configure(const glp_configure& wanted) {
        std::vector<std::uint8_t> payload(32);
        payload.resize(glp_configure_write(&wanted, payload.data(), payload.size()));
        command(glp_frame_configure, payload);
    }

    // What has reached the host since the last call.
    std::vector<ReceivedFrame> take_frames() {
        std::vector<ReceivedFrame> frames;
        std::size_t at = 0;
        while (at < wire.size()) {
            glp_frame frame{};
            bool have_frame = false;
            at += glp_stream_push(&stream_, wire.data() + at, wire.size() - at, &frame, &have_frame);
            if (have_frame) {
                frames.push_back({frame.type,
                                  frame.flags,
                                  frame.sequence,
                                  {frame.payload, frame.payload + frame.payload_bytes}});
            }
        }
        wire.clear();
        return frames;
    }

    std::vector<ReceivedFrame> take_frames(std::uint8_t type) {
        std::vector<ReceivedFrame> frames = take_frames();
        frames.erase(std::remove_if(frames.begin(), frames.end(),
                                    [type](const ReceivedFrame& frame) { return frame.type != type; }),
                     frames.end());
        return frames;
    }

    // Sampled, but neither in a finished frame nor lost.
    std::uint64_t samples_under_way() const {
        return board.frame_samples + (board.instants - board.instants_done);
    }

    const glp_stream& stream() const { return stream_; }

    BenchSensor sensor;
    glp_board board{};
    bool initialised = false;
    std::uint64_t ticks = 1000;
    std::uint32_t sample_period_us = 10'000;
    std::uint32_t read_delay_us = 0;  // between the interrupt and the main loop
    std::size_t endpoint_room = SIZE_MAX;
    std::size_t endpoint_piece = SIZE_MAX;
    std::vector<std::uint8_t> wire;
    int flushes = 0;
    std::uint32_t command_sequence = 100;

private:
    std::uint64_t read_ticks() const { return ticks + read_delay_us; }

    std::size_t accept(const std::uint8_t* bytes, std::size_t size) {
        const std::size_t accepted = std::min({size, endpoint_room, endpoint_piece});
        if (endpoint_room != SIZE_MAX) { endpoint_room -= accepted; }
        wire.insert(wire.end(), bytes, bytes + accepted);
        return accepted;
    }

    glp_hal hal_{};
    glp_board_identity identity_{};
    std::vector<std::uint8_t> ring_;
    glp_stream stream_{};
};

}  // namespace gyrolog
