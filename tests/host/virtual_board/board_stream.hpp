// Test side only: what came out of a virtual board, taken apart into frames.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <gyrolog_protocol/frame_stream.h>
#include <gyrolog_protocol/message.h>

#include "host/base/bytes.hpp"

namespace gyrolog {

class BoardStream {
public:
    BoardStream() { glp_stream_init(&stream_); }

    void feed(ByteView bytes) {
        for (std::size_t at = 0; at < bytes.size();) {
            glp_frame frame{};
            bool have_frame = false;
            at += glp_stream_push(&stream_, bytes.data() + at, bytes.size() - at, &frame, &have_frame);
            if (have_frame) { take(frame); }
        }
    }

    std::map<int, int> frames;  // by type
    std::vector<std::uint32_t> sequences;
    std::vector<std::array<std::int16_t, 3>> gyro;
    std::vector<std::uint64_t> indices;  // of each sample
    std::vector<std::uint64_t> first_ticks;
    std::vector<std::uint64_t> first_indices;
    std::vector<std::uint16_t> flags;  // of each SAMPLES frame
    std::vector<glp_hello> hellos;
    std::vector<int> events;  // codes
    std::vector<glp_reply> replies;
    glp_config config{};
    std::uint32_t lost_samples = 0;

    std::uint64_t bytes_skipped() const { return stream_.bytes_skipped; }
    std::uint64_t frames_refused() const {
        std::uint64_t sum = 0;
        for (const std::uint64_t count : stream_.rejected) { sum += count; }
        return sum;
    }
    std::uint64_t missing_sequences() const {
        std::uint64_t missing = 0;
        for (std::size_t i = 1; i < sequences.size(); ++i) {
            missing += sequences[i] - sequences[i - 1] - 1U;
        }
        return missing;
    }
    bool indices_consecutive() const {
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] != i) { return false; }
        }
        return true;
    }

private:
    void take(const glp_frame& frame) {
        ++frames[frame.type];
        sequences.push_back(frame.sequence);
        glp_samples samples{};
        glp_hello hello{};
        glp_event event{};
        glp_reply reply{};
        if (frame.type == glp_frame_samples && glp_samples_read(&frame, &samples) == glp_status_ok) {
            flags.push_back(frame.flags);
            first_ticks.push_back(samples.first_ticks);
            first_indices.push_back(samples.first_index);
            lost_samples = samples.lost_samples;
            for (std::size_t i = 0; i < samples.count; ++i) {
                indices.push_back(samples.first_index + i);
                gyro.push_back({glp_sample_field(&samples, i, 0), glp_sample_field(&samples, i, 1),
                                glp_sample_field(&samples, i, 2)});
            }
        }
        if (frame.type == glp_frame_hello && glp_hello_read(&frame, &hello) == glp_status_ok) {
            hellos.push_back(hello);
        }
        if (frame.type == glp_frame_event && glp_event_read(&frame, &event) == glp_status_ok) {
            events.push_back(event.code);
        }
        if (frame.type == glp_frame_reply && glp_reply_read(&frame, &reply) == glp_status_ok) {
            replies.push_back(reply);
        }
        if (frame.type == glp_frame_config) { static_cast<void>(glp_config_read(&frame, &config)); }
    }

    glp_stream stream_{};
};

// A command frame with its delimiters.
inline Bytes command_bytes(glp_frame_type type, ByteView payload = {}) {
    glp_frame frame{};
    frame.type = static_cast<std::uint8_t>(type);
    frame.sequence = 77;
    frame.payload = payload.data();
    frame.payload_bytes = payload.size();
    Bytes wire(GLP_FRAME_WIRE_MAX);
    wire.resize(glp_frame_encode(&frame, wire.data(), wire.size()).size);
    return wire;
}

inline Bytes configure_bytes(double rate_hz, unsigned full_scale_dps) {
    glp_configure configure{};
    configure.rate_mHz = static_cast<std::uint32_t>(rate_hz * 1000.0);
    configure.gyro_full_scale_dps = static_cast<std::uint16_t>(full_scale_dps);
    Bytes payload(32);
    payload.resize(glp_configure_write(&configure, payload.data(), payload.size()));
    return command_bytes(glp_frame_configure, payload);
}

}  // namespace gyrolog
