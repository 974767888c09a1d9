// A device that says anything: frames with right checksums, one behind the other, of any type and payload,
// with raw bytes in between. The host's accounts hold, what it makes a recording of is one, and memory is
// bounded by what came.
//
// The input is a list of: type, flags, length, payload. Type FF is raw bytes instead of a frame, FE the
// host's raising of DTR; flag 80 leaves a frame number out in front.

#include <array>
#include <cmath>
#include <cstdint>

#include "host/decode/stream_decoder.hpp"
#include "require.hpp"

extern "C" {
#include <gyrolog_protocol/usb_identity.h>
}

namespace {

using namespace gyrolog;

class Counter final : public MessageHandler {
public:
    std::uint64_t samples = 0;
    std::uint64_t replies = 0;

private:
    void on_samples(const ReceivedFrame& /*frame*/, const glp_samples& frame_samples) override {
        samples += frame_samples.count;
    }
    void on_reply(const ReceivedFrame& /*frame*/, const glp_reply& /*reply*/) override { ++replies; }
};

class Input {
public:
    explicit Input(ByteView bytes) : left_(bytes) {}
    bool empty() const { return left_.size() < 3; }
    std::uint8_t byte() {
        const std::uint8_t value = left_.front();
        left_ = left_.subspan(1);
        return value;
    }
    ByteView take(std::size_t wanted) {
        const ByteView taken = left_.first(std::min(wanted, left_.size()));
        left_ = left_.subspan(taken.size());
        return taken;
    }

private:
    ByteView left_;
};

bool raise_line(StreamDecoder& decoder, HostTime now) {
    Transfer request;
    request.event = Transfer::Event::submission;
    request.kind = TransferKind::control;
    request.setup = {0x21, GLP_CDC_SET_CONTROL_LINE_STATE, GLP_CDC_LINE_DTR};
    request.time = now;
    return decoder.take(request);
}

void require_recording(StreamDecoder& decoder) {
    auto recording = decoder.take_recording("fuzz");
    if (!recording.ok()) {
        GYROLOG_REQUIRE(recording.error().code == ErrorCode::malformed);
        return;
    }
    GYROLOG_REQUIRE(std::isfinite(recording->rate_hz) && recording->rate_hz > 0.0);
    std::size_t rows = 0;
    std::int64_t free_from = std::numeric_limits<std::int64_t>::min();
    for (const Segment& segment : recording->segments) {
        GYROLOG_REQUIRE(segment.first == rows && segment.count > 0);
        GYROLOG_REQUIRE(segment.first_index >= free_from);
        rows += segment.count;
        free_from = segment.first_index + static_cast<std::int64_t>(segment.count);
    }
    GYROLOG_REQUIRE(rows == recording->rows());
    for (const Column& column : recording->columns) { GYROLOG_REQUIRE(column.size() == rows); }
    if (recording->samples_per_row > 1) { return; }
    std::int64_t missing = 0;
    for (const Dropout& dropout : recording->dropouts) { missing += dropout.samples; }
    GYROLOG_REQUIRE(missing == recording->missing_samples());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Counter counter;
    StreamDecoder decoder({.keep_samples = true, .observer = &counter});
    StreamDecoder in_means({.keep_samples = true, .samples_per_row = 3});
    Input input({data, size});
    HostTime now{1'000'000'000, 0};
    std::uint32_t sequence = 0;
    std::uint64_t fed = 0;
    while (!input.empty()) {
        const std::uint8_t type = input.byte();
        const std::uint8_t flags = input.byte();
        const std::size_t length = input.byte();
        const ByteView payload = input.take(length);
        now.monotonic_ns += 16'000'000;
        if (type == 0xFE) {
            if (raise_line(decoder, now)) { counter = Counter(); }
            static_cast<void>(raise_line(in_means, now));
            continue;
        }
        if (type == 0xFF) {
            decoder.feed(payload, now);
            in_means.feed(payload, now);
            fed += payload.size();
            continue;
        }
        if ((flags & 0x80U) != 0) { ++sequence; }
        const glp_frame frame{type, static_cast<std::uint16_t>(flags & 0x7FU), sequence++, payload.data(),
                              payload.size()};
        std::array<std::uint8_t, GLP_FRAME_WIRE_MAX> wire{};
        const glp_cobs_result encoded = glp_frame_encode(&frame, wire.data(), wire.size());
        GYROLOG_REQUIRE(encoded.status == glp_status_ok);
        decoder.feed(ByteView(wire).first(encoded.size), now);
        in_means.feed(ByteView(wire).first(encoded.size), now);
        fed += encoded.size;
    }
    const LinkReport report = decoder.report();
    GYROLOG_REQUIRE(report.bytes.balanced());
    GYROLOG_REQUIRE(report.bytes.total == fed);
    GYROLOG_REQUIRE(report.samples.good == counter.samples);
    GYROLOG_REQUIRE(counter.replies <= report.frames.good);
    std::uint64_t corrupted = 0;
    for (const std::uint64_t count : report.frames.corrupted_by_reason) { corrupted += count; }
    GYROLOG_REQUIRE(report.frames.corrupted == corrupted);
    GYROLOG_REQUIRE(corrupted <= fed);
    for (const Dropout& dropout : decoder.timed(report.dropouts)) {
        GYROLOG_REQUIRE(std::isfinite(dropout.at_s));
        // A board that was reset may be back before the next sample was due.
        GYROLOG_REQUIRE(dropout.samples > 0 || dropout.cause == "reset");
    }
    if (const auto rate_hz = decoder.rate_hz()) { GYROLOG_REQUIRE(std::isfinite(*rate_hz)); }
    if (const auto fit = decoder.timeline().host_clock()) { GYROLOG_REQUIRE(std::isfinite(fit->ratio)); }
    require_recording(decoder);
    require_recording(in_means);
    return 0;
}
