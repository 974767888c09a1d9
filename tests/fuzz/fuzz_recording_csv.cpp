// Any text at all: parsing ends in a recording that keeps its promises, or in an error with a message.

#include <cmath>
#include <cstdint>
#include <string_view>

#include "host/formats/recording_csv.hpp"
#include "tests/fuzz/require.hpp"

namespace {

void check_promises(const gyrolog::Recording& recording) {
    GYROLOG_REQUIRE(recording.rate_hz > 0.0 && std::isfinite(recording.rate_hz));
    GYROLOG_REQUIRE(recording.rows() > 0);
    std::size_t row = 0;
    std::int64_t index = -1;
    for (const gyrolog::Segment& segment : recording.segments) {
        GYROLOG_REQUIRE(segment.first == row && segment.count > 0 && segment.first_index > index);
        row += segment.count;
        index = segment.first_index + static_cast<std::int64_t>(segment.count) - 1;
    }
    GYROLOG_REQUIRE(row == recording.rows());
    GYROLOG_REQUIRE(recording.t_s.empty() || recording.t_s.size() == row);
    std::int64_t missing = 0;
    for (const gyrolog::Dropout& dropout : recording.dropouts) { missing += dropout.samples; }
    GYROLOG_REQUIRE(missing == recording.missing_samples());
    for (const gyrolog::Column& column : recording.columns) {
        GYROLOG_REQUIRE(column.size() == row);
        if (column.name[0] != 'g') { continue; }
        for (std::size_t i = 0; i < row; ++i) { GYROLOG_REQUIRE(!std::isnan(column.value(i))); }
    }
}

}  // namespace

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
            check_promises(*recording);
        } else {
            GYROLOG_REQUIRE(!recording.error().message.empty());
        }
    }
    return 0;
}
