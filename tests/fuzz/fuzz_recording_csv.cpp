// Any text at all: parsing ends in a recording that keeps its promises, or in an error with a message.

#include <cstdint>
#include <string_view>

#include "host/formats/recording_csv.hpp"
#include "tests/fuzz/recording_promises.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    gyrolog::CsvReadOptions options;
    options.lsb_dps = 0.015;
    for (const bool with_rate : {false, true, true}) {
        // The third time, in means.
        if (options.rate_hz) { options.samples_per_row = 2; }
        if (with_rate) { options.rate_hz = 100.0; }
        const auto recording = gyrolog::parse_recording_csv(text, "fuzz", options);
        if (recording.ok()) {
            gyrolog::check_promises(*recording);
        } else {
            GYROLOG_REQUIRE(!recording.error().message.empty());
        }
    }
    return 0;
}
