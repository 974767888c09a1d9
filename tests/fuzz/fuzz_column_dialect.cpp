// Any text of another program's, with what a user may say of its columns: parsing ends in a recording that
// keeps its promises and says what was taken for what, or in an error with a message of some length at most.
// The first line is what --columns says; an empty one says nothing.

#include <cstdint>
#include <string_view>

#include "host/formats/recording_csv.hpp"
#include "tests/fuzz/recording_promises.hpp"

namespace {

// Of ten names of 40 bytes each, all of them escaped.
constexpr std::size_t message_bytes_most = 3000;

void parse(std::string_view text, const gyrolog::CsvReadOptions& options) {
    const auto recording = gyrolog::parse_recording_csv(text, "fuzz", options);
    if (recording.ok()) {
        gyrolog::check_promises(*recording);
        return;
    }
    const std::string& message = recording.error().message;
    GYROLOG_REQUIRE(!message.empty() && message.size() < message_bytes_most);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view input(reinterpret_cast<const char*>(data), size);
    const std::size_t line = std::min(input.find('\n'), input.size());
    const std::string_view text = input.substr(std::min(line + 1, input.size()));
    gyrolog::CsvReadOptions options;
    options.needs_gyro = false;
    options.choice.columns = std::string(input.substr(0, std::min<std::size_t>(line, 200)));
    parse(text, options);
    options.choice.gyro_unit = "deg/s";
    options.choice.accelerometer_unit = "g";
    parse(text, options);
    options.choice.columns.clear();
    options.rate_hz = 100.0;
    parse(text, options);
    return 0;
}
