// Any bytes as an .npy: parsing ends in a recording that keeps its promises, or in an error with a message.
// Arrays whose size is right are made from the bytes, as no mutation finds it.

#include <cstdint>
#include <string>
#include <string_view>

#include "host/formats/recording_npy.hpp"
#include "tests/fuzz/recording_promises.hpp"

namespace {

void parse(std::string_view file, const gyrolog::RecordingReadOptions& options) {
    const auto recording = gyrolog::parse_recording_npy(file, "fuzz", options);
    if (recording.ok()) {
        gyrolog::check_promises(*recording);
    } else {
        GYROLOG_REQUIRE(!recording.error().message.empty());
    }
}

// Of the kind that the first byte says, with as many rows as the others fill.
std::string array_of(std::string_view bytes) {
    constexpr const char* types[] = {"<f8", "<f4", "<i4", "<i2"};
    constexpr std::size_t sizes[] = {8, 4, 4, 2};
    const auto kind = static_cast<std::uint8_t>(bytes.front());
    const std::size_t columns = 1U + (kind >> 2U) % 4U;
    const std::size_t rows = (bytes.size() - 1) / (columns * sizes[kind % 4U]);
    const std::string header = std::string("{'descr': '") + types[kind % 4U] +
                               "', 'fortran_order': " + ((kind & 0x40U) != 0U ? "True" : "False") +
                               ", 'shape': (" + std::to_string(rows) + ", " + std::to_string(columns) + ")}";
    std::string file = "\x93NUMPY\x01";
    file += '\0';
    file += static_cast<char>(header.size());
    file += '\0';
    return file + header + std::string(bytes.substr(1, rows * columns * sizes[kind % 4U]));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    gyrolog::RecordingReadOptions options;
    options.choice = {.columns = "t,gx,gy", .gyro_unit = "rad/s"};
    parse(bytes, options);
    if (bytes.empty()) { return 0; }
    parse(array_of(bytes), options);
    options.choice = {.columns = "gx", .gyro_unit = "lsb"};
    options.rate_hz = 100.0;
    options.lsb_dps = 0.015;
    options.samples_per_row = 2;
    parse(array_of(bytes), options);
    return 0;
}
