// A board's stream made on the spot, frame by frame, with the device's own encoder.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "host/base/bytes.hpp"
#include "host/decode/protocol.hpp"
#include "host/decode/stream_decoder.hpp"

namespace gyrolog {

// Counts a sample's fields so that every value can be checked.
inline std::int16_t made_value(std::uint64_t index, std::size_t field) {
    return static_cast<std::int16_t>((index * 7 + field * 1000) % 60000 - 30000);
}

class MadeBoard {
public:
    glp_hello hello{};
    glp_config config{};
    std::uint8_t layout = glp_layout_gyro | glp_layout_accel;
    double rate_hz = 1003.0;  // of the sensor, by the board's clock
    double host_ratio = 1.0;  // host seconds per board second
    double start_s = 0.0;     // board time of index 0
    std::uint64_t ticks_offset = 0;
    std::uint32_t sequence = 0;
    std::uint64_t index = 0;
    std::uint32_t lost_samples = 0;
    std::uint32_t lost_frames = 0;
    double delay_s = 0.001;  // from the frame's last sample to its arrival

    MadeBoard() {
        hello.protocol_major = 1;
        hello.tick_bits = 32;
        hello.who_am_i = 0x71;
        hello.tick_hz = 1'000'000;
        hello.boot_id = 0xB001;
        config.generation = 1;
        config.layout = layout;
        config.samples_per_frame = 16;
        config.rate_mHz = 1'000'000;
        config.gyro_full_scale_dps = 500;
        config.accel_full_scale_g = 8;
        config.dlpf_hz = 184;
        config.decimation = 1;
        config.gyro_ndps_per_lsb = 15'267'176;
        config.accel_pg_per_lsb = 244'140'625;
        config.temp_nC_per_lsb = 2'995'177;
        config.temp_offset_mC = 21'000;
    }

    Bytes hello_frame() {
        std::uint8_t payload[GLP_FRAME_PAYLOAD_MAX];
        return frame(glp_frame_hello, 0, {payload, glp_hello_write(&hello, payload, sizeof payload)});
    }
    Bytes config_frame() {
        std::uint8_t payload[GLP_FRAME_PAYLOAD_MAX];
        return frame(glp_frame_config, 0, {payload, glp_config_write(&config, payload, sizeof payload)});
    }
    Bytes samples_frame(std::uint16_t flags = 0, std::uint8_t count = 16) {
        Bytes values;
        const std::size_t fields = glp_sample_bytes(layout) / 2;
        for (std::uint64_t i = index; i < index + count; ++i) {
            for (std::size_t field = 0; field < fields; ++field) {
                const auto bits = static_cast<std::uint16_t>(made_value(i, field));
                values.push_back(static_cast<std::uint8_t>(bits));
                values.push_back(static_cast<std::uint8_t>(bits >> 8U));
            }
        }
        const glp_samples samples{ticks(), index,  config.generation, 100, lost_samples,
                                  count,   layout, values.data()};
        std::uint8_t payload[GLP_FRAME_PAYLOAD_MAX];
        index += count;
        return frame(glp_frame_samples, flags,
                     {payload, glp_samples_write(&samples, payload, sizeof payload)});
    }
    Bytes status_frame() {
        glp_device_status status{};
        status.ticks = ticks();
        status.next_index = index;
        status.lost_samples = lost_samples;
        status.lost_frames = lost_frames;
        status.streaming = 1;
        std::uint8_t payload[GLP_FRAME_PAYLOAD_MAX];
        return frame(glp_frame_status, 0,
                     {payload, glp_device_status_write(&status, payload, sizeof payload)});
    }
    Bytes event_frame(glp_event_code code) {
        glp_event event{};
        event.ticks = ticks();
        event.index = index;
        event.code = static_cast<std::uint16_t>(code);
        event.value = code == glp_event_stopped ? static_cast<std::int32_t>(lost_samples) : 0;
        std::uint8_t payload[GLP_FRAME_PAYLOAD_MAX];
        return frame(glp_frame_event, 0, {payload, glp_event_write(&event, payload, sizeof payload)});
    }
    Bytes frame(glp_frame_type type, std::uint16_t flags, ByteView payload) {
        EXPECT_GT(payload.size(), 0U);
        const glp_frame made{static_cast<std::uint8_t>(type), flags, sequence++, payload.data(),
                             payload.size()};
        std::uint8_t wire[GLP_FRAME_WIRE_MAX];
        const glp_cobs_result encoded = glp_frame_encode(&made, wire, sizeof wire);
        EXPECT_EQ(encoded.status, glp_status_ok);
        return {wire, wire + encoded.size};
    }

    // The sensor goes on, and nothing of it is kept on the board.
    void lose_samples(std::uint32_t count) {
        index += count;
        lost_samples += count;
    }
    void restart(double at_s) {
        start_s = at_s;
        index = 0;
        lost_samples = 0;
    }

    double time_s() const { return start_s + static_cast<double>(index) / rate_hz; }
    std::uint64_t ticks() const {
        const auto whole = static_cast<std::uint64_t>(std::llround(time_s() * hello.tick_hz)) + ticks_offset;
        return hello.tick_bits >= 64 ? whole : whole & ((std::uint64_t{1} << hello.tick_bits) - 1);
    }
    HostTime now() const {
        return {100'000'000'000 + std::llround((time_s() * host_ratio + delay_s) * 1e9), 0};
    }
};

// A decoder, and what a fresh board says first.
struct Listening {
    explicit Listening(std::size_t samples_per_row = 1)
        : decoder({.keep_samples = true, .samples_per_row = samples_per_row}) {}

    MadeBoard board;
    StreamDecoder decoder;
    std::uint64_t bytes = 0;

    void hear(const Bytes& wire) {
        decoder.feed(wire, board.now());
        bytes += wire.size();
    }
    void begin() {
        hear(board.hello_frame());
        hear(board.config_frame());
        hear(board.samples_frame(glp_flag_first_after_start));
    }
    void hear_samples(std::size_t frames) {
        for (std::size_t i = 0; i < frames; ++i) { hear(board.samples_frame()); }
    }
};

}  // namespace gyrolog
