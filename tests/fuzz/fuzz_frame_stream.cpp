// Any bytes, cut anywhere: every byte is accounted for, the cuts change nothing, and what comes out is a
// frame that encodes again to bytes that were there.

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gyrolog_protocol/frame_stream.h>
#include <gyrolog_protocol/message.h>

#include "require.hpp"

namespace {

struct Outcome {
    glp_stream stream;
    std::vector<std::vector<std::uint8_t>> frames;
};

void require_accounts(const glp_stream& stream) {
    GYROLOG_REQUIRE(stream.bytes_in ==
                    stream.bytes_in_frames + stream.bytes_skipped + glp_stream_buffered(&stream));
    GYROLOG_REQUIRE(stream.encoded_bytes <= GLP_FRAME_ENCODED_MAX);
}

std::vector<std::uint8_t> on_wire(const glp_frame& frame) {
    std::vector<std::uint8_t> wire(GLP_FRAME_WIRE_MAX);
    const glp_cobs_result encoded = glp_frame_encode(&frame, wire.data(), wire.size());
    GYROLOG_REQUIRE(encoded.status == glp_status_ok);
    wire.resize(encoded.size);
    return wire;
}

// Cuts the bytes into pieces whose sizes go round through `step`, `step + 1`, ...; 0 leaves them whole.
Outcome read(const std::uint8_t* data, std::size_t size, std::size_t step) {
    Outcome outcome;
    glp_stream_init(&outcome.stream);
    std::size_t piece = step;
    for (std::size_t at = 0; at < size;) {
        const std::size_t end = step == 0 ? size : std::min(size, at + piece);
        piece = piece >= step + 100 ? step : piece + 1;
        while (at < end) {
            glp_frame frame{};
            bool have_frame = false;
            const std::size_t taken =
                glp_stream_push(&outcome.stream, data + at, end - at, &frame, &have_frame);
            GYROLOG_REQUIRE(taken > 0 && taken <= end - at);
            at += taken;
            require_accounts(outcome.stream);
            if (have_frame) { outcome.frames.push_back(on_wire(frame)); }
        }
    }
    return outcome;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Outcome whole = read(data, size, 0);
    GYROLOG_REQUIRE(whole.stream.bytes_in == size);
    for (const std::size_t step : {std::size_t{1}, std::size_t{64}}) {
        const Outcome cut = read(data, size, step);
        GYROLOG_REQUIRE(cut.frames == whole.frames);
        GYROLOG_REQUIRE(cut.stream.bytes_skipped == whole.stream.bytes_skipped);
        GYROLOG_REQUIRE(std::equal(std::begin(cut.stream.rejected), std::end(cut.stream.rejected),
                                   std::begin(whole.stream.rejected)));
    }
    const std::uint8_t* from = data;
    for (const std::vector<std::uint8_t>& wire : whole.frames) {
        // Between its delimiters, the first of which may be missing at the very beginning.
        from = std::search(from, data + size, wire.begin() + 1, wire.end());
        GYROLOG_REQUIRE(from != data + size);
    }
    return 0;
}
