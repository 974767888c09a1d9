// Any bytes as a text file, compressed or not: reading ends, in memory that a piece bounds, with no more text
// than the limits allow for the file's size, or with an error that has a message.

#include <cstdint>

#include "host/formats/input_limits.hpp"
#include "host/formats/text_file.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace gyrolog;
    const MemoryFile file({data, size});
    auto reader = TextReader::open(file.path());
    if (!reader.ok()) {
        GYROLOG_REQUIRE(!reader.error().message.empty());
        return 0;
    }
    constexpr std::size_t enough_bytes = std::size_t{4} << 20U;  // a bomb's way to the limit takes long
    std::size_t text_bytes = 0;
    while (text_bytes < enough_bytes) {
        const auto piece = reader->read();
        if (!piece.ok()) {
            GYROLOG_REQUIRE(!piece.error().message.empty());
            return 0;
        }
        if (piece->empty()) { break; }
        text_bytes += piece->size();
    }
    GYROLOG_REQUIRE(text_bytes <= input_limits.unpacked_free_bytes + input_limits.unpacked_ratio_most * size);
    return 0;
}
