// Any bytes at all are a capture file to be read, accounted for and recovered: nothing may be unaccounted
// for, and what was recovered must read as the same transfers, without damage.
#include <cstdint>
#include <memory>

#include "host/capture/append_file.hpp"
#include "host/capture/capture_reader.hpp"
#include "host/capture/recover.hpp"
#include "tests/fuzz/require.hpp"

namespace gyrolog {
namespace {

struct Reading {
    bool opened = false;
    std::uint64_t transfers = 0;
    std::uint64_t stream_bytes = 0;
    BlockAccounts blocks;
};

Reading read(const Bytes& bytes) {
    Reading reading;
    auto reader = CaptureReader::open(input_from_memory(bytes));
    if (!reader.ok()) { return reading; }
    reading.opened = true;
    std::uint64_t last_offset = 0;
    while (true) {
        const auto captured = reader->next();
        GYROLOG_REQUIRE(captured.ok());
        if (!captured->has_value()) { break; }
        GYROLOG_REQUIRE((*captured)->offset >= last_offset);
        last_offset = (*captured)->offset;
        if ((*captured)->transfer.carries_stream()) {
            reading.stream_bytes += (*captured)->transfer.data.size();
        }
    }
    const CaptureAccounts accounts = reader->accounts();
    GYROLOG_REQUIRE(accounts.blocks.balanced());
    GYROLOG_REQUIRE(accounts.blocks.bytes_total == bytes.size());
    GYROLOG_REQUIRE(accounts.stream_bytes == reading.stream_bytes);
    GYROLOG_REQUIRE(accounts.stream_bytes <= bytes.size());
    reading.transfers = accounts.transfers;
    reading.blocks = accounts.blocks;
    return reading;
}

}  // namespace
}  // namespace gyrolog

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace gyrolog;
    const Bytes bytes(data, data + size);
    const Reading before = read(bytes);
    if (!before.opened) { return 0; }
    Bytes recovered;
    const auto report = recover_capture(input_from_memory(bytes), [&](ByteView piece) {
        recovered.insert(recovered.end(), piece.begin(), piece.end());
        return Status();
    });
    GYROLOG_REQUIRE(report.ok());
    GYROLOG_REQUIRE(report->bytes_kept == recovered.size());
    if (before.blocks.blocks == 0) { return 0; }
    const Reading after = read(recovered);
    GYROLOG_REQUIRE(after.opened);
    GYROLOG_REQUIRE(after.blocks.end == FileEnd::clean);
    GYROLOG_REQUIRE(after.transfers == before.transfers);
    GYROLOG_REQUIRE(after.stream_bytes == before.stream_bytes);
    return 0;
}
