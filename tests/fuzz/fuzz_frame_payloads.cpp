// The first byte is a frame's type, the rest its payload. Reading never goes astray, and what was read can be
// written and read again to the same.

#include <cstdint>
#include <vector>

#include <gyrolog_protocol/message.h>

#include "require.hpp"

namespace {

using Payload = std::vector<std::uint8_t>;

template <typename Message, typename Read, typename Write>
void round_trip(const glp_frame& frame, Read read, Write write) {
    Message message{};
    if (read(&frame, &message) != glp_status_ok) { return; }
    Payload once(GLP_FRAME_PAYLOAD_MAX);
    once.resize(write(&message, once.data(), once.size()));
    GYROLOG_REQUIRE(!once.empty());
    GYROLOG_REQUIRE(once.size() <= frame.payload_bytes);

    const glp_frame again{frame.type, 0, 0, once.data(), once.size()};
    Message same{};
    GYROLOG_REQUIRE(read(&again, &same) == glp_status_ok);
    Payload twice(GLP_FRAME_PAYLOAD_MAX);
    twice.resize(write(&same, twice.data(), twice.size()));
    GYROLOG_REQUIRE(once == twice);
    // One byte less than is needed must be no space, not a write past the end.
    Payload small(once.size() - 1);
    GYROLOG_REQUIRE(write(&message, small.data(), small.size()) == 0);
}

void read_every_sample(const glp_frame& frame) {
    glp_samples samples{};
    if (glp_samples_read(&frame, &samples) != glp_status_ok) { return; }
    GYROLOG_REQUIRE(samples.count <= glp_samples_per_frame_max(samples.layout));
    const std::size_t fields = glp_sample_bytes(samples.layout) / 2;
    const std::uint8_t* place = samples.samples;
    for (std::size_t i = 0; i < samples.count; ++i) {
        for (std::size_t k = 0; k < fields; ++k, place += 2) {
            const int wanted = static_cast<std::int16_t>(place[0] | place[1] << 8);
            GYROLOG_REQUIRE(glp_sample_field(&samples, i, k) == wanted);
        }
    }
    GYROLOG_REQUIRE(place == frame.payload + frame.payload_bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 1 || size - 1 > GLP_FRAME_PAYLOAD_MAX) { return 0; }
    const Payload payload(data + 1, data + size);  // on its own, so that the sanitizers see its end
    const glp_frame frame{data[0], 0, 0, payload.data(), payload.size()};
    round_trip<glp_hello>(frame, glp_hello_read, glp_hello_write);
    round_trip<glp_config>(frame, glp_config_read, glp_config_write);
    round_trip<glp_samples>(frame, glp_samples_read, glp_samples_write);
    round_trip<glp_device_status>(frame, glp_device_status_read, glp_device_status_write);
    round_trip<glp_event>(frame, glp_event_read, glp_event_write);
    round_trip<glp_reply>(frame, glp_reply_read, glp_reply_write);
    round_trip<glp_configure>(frame, glp_configure_read, glp_configure_write);
    read_every_sample(frame);
    return 0;
}
