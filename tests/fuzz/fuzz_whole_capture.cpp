// Any bytes at all as a capture, from the file to the recording: blocks, transfers, frames, accounts, time.
// The mutator mends lengths, hashes and checksums, so that what is changed is what they vouch for.

#include <cmath>
#include <cstdint>

#include "host/session/load_capture.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/recording_promises.hpp"

namespace {

using namespace gyrolog;

void check_accounts(const LoadedCapture& capture, std::size_t file_bytes) {
    const BlockAccounts& blocks = capture.file.blocks;
    GYROLOG_REQUIRE(blocks.balanced());
    GYROLOG_REQUIRE(blocks.bytes_total == file_bytes);
    GYROLOG_REQUIRE(blocks.blocks > 0);
    GYROLOG_REQUIRE(blocks.bytes_behind_close <= blocks.bytes_in_tail);
    const LinkReport report = capture.decoder->report();
    GYROLOG_REQUIRE(report.bytes.balanced());
    GYROLOG_REQUIRE(report.bytes.total <= capture.file.stream_bytes);
    for (const std::string& contradiction : capture.contradictions()) {
        GYROLOG_REQUIRE(!contradiction.empty());
    }
    GYROLOG_REQUIRE(!report.complete() || sentences(report.contradictions).empty());
    for (const Dropout& dropout : capture.decoder->timed(report.dropouts)) {
        GYROLOG_REQUIRE(std::isfinite(dropout.at_s));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const MemoryFile file({data, size});
    const auto capture = load_capture(file.path(), true);
    if (!capture.ok()) {
        GYROLOG_REQUIRE(!capture.error().message.empty());
        return 0;
    }
    check_accounts(*capture, size);
    const auto recording = capture->decoder->take_recording("fuzz");
    if (recording.ok()) {
        check_promises(*recording);
    } else {
        GYROLOG_REQUIRE(!recording.error().message.empty());
    }
    return 0;
}
