// Runs the files of firmware_protocol/vectors, which a second implementation has written from SPEC.md.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <gyrolog_protocol/message.h>

#include "wire.hpp"

namespace gyrolog {
namespace {

using Fields = std::map<std::string, std::string>;

std::filesystem::path vectors() {
    const char* source = std::getenv("GYROLOG_SOURCE_DIR");
    return std::filesystem::path(source != nullptr ? source : ".") / "firmware_protocol/vectors";
}

WireBytes from_hex(const std::string& text) {
    WireBytes bytes;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
        bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
    }
    return bytes;
}

std::string to_hex(const std::uint8_t* bytes, std::size_t size) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) {
        constexpr char digits[] = "0123456789abcdef";
        text += digits[bytes[i] >> 4U];
        text += digits[bytes[i] & 15U];
    }
    return text;
}

Fields read_vector(const std::filesystem::path& path) {
    Fields fields;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) { continue; }
        const std::size_t colon = line.find(':');
        const std::size_t value = line.find_first_not_of(' ', colon + 1);
        fields[line.substr(0, colon)] = value == std::string::npos ? "" : line.substr(value);
    }
    return fields;
}

// What a message says, spelled as the vectors spell it.
class Description {
public:
    template <typename Number>
    void add(const char* name, Number number) {
        fields_[name] = std::to_string(number);
    }
    void add_text(const char* name, const std::string& text) { fields_[name] = text; }
    Fields take() { return std::move(fields_); }

private:
    Fields fields_;
};

glp_status describe_hello(const glp_frame& frame, Description& out) {
    glp_hello hello{};
    const glp_status status = glp_hello_read(&frame, &hello);
    out.add("hello.protocol_major", hello.protocol_major);
    out.add("hello.protocol_minor", hello.protocol_minor);
    out.add("hello.tick_bits", hello.tick_bits);
    out.add("hello.who_am_i", hello.who_am_i);
    out.add("hello.tick_hz", hello.tick_hz);
    out.add("hello.boot_id", hello.boot_id);
    out.add("hello.reset_cause", hello.reset_cause);
    out.add_text("hello.uid", to_hex(hello.uid, sizeof hello.uid));
    out.add_text("hello.firmware", hello.firmware);
    out.add_text("hello.sensor", hello.sensor);
    return status;
}

glp_status describe_config(const glp_frame& frame, Description& out) {
    glp_config config{};
    const glp_status status = glp_config_read(&frame, &config);
    out.add("config.generation", config.generation);
    out.add("config.layout", config.layout);
    out.add("config.samples_per_frame", config.samples_per_frame);
    out.add("config.rate_mHz", config.rate_mHz);
    out.add("config.gyro_full_scale_dps", config.gyro_full_scale_dps);
    out.add("config.accel_full_scale_g", config.accel_full_scale_g);
    out.add("config.dlpf_hz", config.dlpf_hz);
    out.add("config.decimation", config.decimation);
    out.add("config.gyro_ndps_per_lsb", config.gyro_ndps_per_lsb);
    out.add("config.accel_pg_per_lsb", config.accel_pg_per_lsb);
    out.add("config.temp_nC_per_lsb", config.temp_nC_per_lsb);
    out.add("config.temp_offset_mC", config.temp_offset_mC);
    out.add_text("config.registers", to_hex(config.registers, sizeof config.registers));
    return status;
}

glp_status describe_samples(const glp_frame& frame, Description& out) {
    glp_samples samples{};
    const glp_status status = glp_samples_read(&frame, &samples);
    if (status != glp_status_ok) { return status; }
    out.add("samples.first_ticks", samples.first_ticks);
    out.add("samples.first_index", samples.first_index);
    out.add("samples.config_generation", samples.config_generation);
    out.add("samples.temperature", samples.temperature);
    out.add("samples.lost_samples", samples.lost_samples);
    out.add("samples.count", samples.count);
    out.add("samples.layout", samples.layout);
    const std::size_t fields = glp_sample_bytes(samples.layout) / 2;
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < samples.count; ++i) {
        for (std::size_t k = 0; k < fields; ++k) { sum += glp_sample_field(&samples, i, k); }
    }
    out.add("samples.first_count", glp_sample_field(&samples, 0, 0));
    out.add("samples.last_count", glp_sample_field(&samples, samples.count - 1U, fields - 1));
    out.add("samples.sum_of_counts", sum);
    return status;
}

glp_status describe_status(const glp_frame& frame, Description& out) {
    glp_device_status device{};
    const glp_status status = glp_device_status_read(&frame, &device);
    out.add("status.ticks", device.ticks);
    out.add("status.next_index", device.next_index);
    out.add("status.lost_samples", device.lost_samples);
    out.add("status.lost_frames", device.lost_frames);
    out.add("status.ring_bytes", device.ring_bytes);
    out.add("status.ring_high_water_bytes", device.ring_high_water_bytes);
    out.add("status.usb_frame_number", device.usb_frame_number);
    out.add("status.fifo_overflows", device.fifo_overflows);
    out.add("status.bus_errors", device.bus_errors);
    out.add("status.temperature", device.temperature);
    out.add("status.streaming", device.streaming);
    out.add("status.reset_cause", device.reset_cause);
    return status;
}

glp_status describe_event(const glp_frame& frame, Description& out) {
    glp_event event{};
    const glp_status status = glp_event_read(&frame, &event);
    if (status != glp_status_ok) { return status; }
    out.add("event.ticks", event.ticks);
    out.add("event.index", event.index);
    out.add("event.code", event.code);
    out.add("event.text_bytes", event.text_bytes);
    out.add("event.value", event.value);
    out.add_text("event.text", std::string(event.text, event.text_bytes));
    return status;
}

glp_status describe_reply(const glp_frame& frame, Description& out) {
    glp_reply reply{};
    const glp_status status = glp_reply_read(&frame, &reply);
    out.add("reply.command_sequence", reply.command_sequence);
    out.add("reply.command_type", reply.command_type);
    out.add("reply.result", reply.result);
    return status;
}

glp_status describe_configure(const glp_frame& frame, Description& out) {
    glp_configure configure{};
    const glp_status status = glp_configure_read(&frame, &configure);
    out.add("configure.rate_mHz", configure.rate_mHz);
    out.add("configure.gyro_full_scale_dps", configure.gyro_full_scale_dps);
    out.add("configure.accel_full_scale_g", configure.accel_full_scale_g);
    out.add("configure.dlpf_hz", configure.dlpf_hz);
    out.add("configure.layout", configure.layout);
    out.add("configure.samples_per_frame", configure.samples_per_frame);
    return status;
}

glp_status describe(const glp_frame& frame, Description& out) {
    out.add("type", frame.type);
    out.add("flags", frame.flags);
    out.add("sequence", frame.sequence);
    out.add("payload_bytes", frame.payload_bytes);
    switch (frame.type) {
        case glp_frame_hello:
            return describe_hello(frame, out);
        case glp_frame_config:
            return describe_config(frame, out);
        case glp_frame_samples:
            return describe_samples(frame, out);
        case glp_frame_status:
            return describe_status(frame, out);
        case glp_frame_event:
            return describe_event(frame, out);
        case glp_frame_reply:
            return describe_reply(frame, out);
        case glp_frame_configure:
            return describe_configure(frame, out);
        default:
            return glp_status_ok;
    }
}

void expect_frame(const Fields& wanted) {
    const WireBytes encoded = from_hex(wanted.at("bytes"));
    WireBytes body(GLP_FRAME_BODY_MAX);
    glp_frame frame{};
    glp_status status = glp_frame_decode(encoded.data(), encoded.size(), body.data(), &frame);
    Description description;
    if (status == glp_status_ok) { status = describe(frame, description); }
    EXPECT_EQ(glp_status_name(status), wanted.at("expect"));
    if (status != glp_status_ok) { return; }

    Fields seen = description.take();
    seen["spec"] = wanted.at("spec");
    seen["bytes"] = wanted.at("bytes");
    seen["expect"] = "ok";
    EXPECT_EQ(seen, wanted);

    WireBytes wire(GLP_FRAME_WIRE_MAX);
    const glp_cobs_result again = glp_frame_encode(&frame, wire.data(), wire.size());
    ASSERT_EQ(again.status, glp_status_ok);
    EXPECT_EQ(to_hex(wire.data() + 1, again.size - 2), wanted.at("bytes")) << "written again, it differs";
}

void expect_stream(const Fields& wanted, std::size_t piece) {
    const WireBytes bytes = from_hex(wanted.at("stream"));
    glp_stream stream;
    glp_stream_init(&stream);
    std::ostringstream frames;
    const auto list_frame = [&frames](const glp_frame& frame) {
        frames << (frames.tellp() > 0 ? " " : "") << unsigned{frame.type} << ':' << frame.sequence;
    };
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
        feed(stream, bytes.data() + at, std::min(piece, bytes.size() - at), list_frame);
    }
    EXPECT_EQ(frames.str(), wanted.at("frames"));
    EXPECT_EQ(std::to_string(stream.bytes_in_frames), wanted.at("in_frames"));
    EXPECT_EQ(std::to_string(stream.bytes_skipped), wanted.at("skipped"));
    EXPECT_EQ(std::to_string(glp_stream_buffered(&stream)), wanted.at("waiting"));
}

void run_folder(const char* folder, std::size_t at_least) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(vectors() / folder)) {
        const Fields wanted = read_vector(entry.path());
        SCOPED_TRACE(entry.path().filename().string() + ", rule " + wanted.at("spec"));
        ++files;
        if (wanted.contains("bytes")) { expect_frame(wanted); }
        if (wanted.contains("stream")) {
            for (const std::size_t piece : {std::size_t{1}, std::size_t{64}, std::size_t{4096}}) {
                expect_stream(wanted, piece);
            }
        }
    }
    EXPECT_GE(files, at_least) << "vectors are missing from " << (vectors() / folder);
}

TEST(Conformance, AcceptsEveryVectorOfTheAcceptFolderAndReadsItsFields) { run_folder("accept", 70); }

TEST(Conformance, RefusesEveryVectorOfTheRejectFolderForTheReasonItNames) { run_folder("reject", 50); }

}  // namespace
}  // namespace gyrolog
