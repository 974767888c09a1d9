#include "host/session/load_capture.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace gyrolog {
namespace {

// 0 when it cannot be known.
std::uint64_t size_of(const std::string& path) {
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(path, unknown);
    return unknown ? 0 : size;
}

}  // namespace

Result<LoadedCapture> load_capture(const std::string& path, bool keep_samples,
                                   const StageObserver& on_stage) {
    GYROLOG_TRY(CaptureReader reader, CaptureReader::open(path));
    LoadedCapture loaded;
    loaded.decoder = std::make_unique<StreamDecoder>(StreamDecoderOptions{
        .keep_samples = keep_samples, .observer = nullptr, .stream_bytes = size_of(path)});
    bool any_data = false;
    while (true) {
        on_stage("read");
        GYROLOG_TRY(const std::optional<CapturedTransfer> captured, reader.next());
        if (!captured) { break; }
        const Transfer& transfer = captured->transfer;
        if (!any_data && transfer.carries_stream() && !transfer.data.empty()) {
            loaded.first_data = transfer.time;
            any_data = true;
        }
        on_stage("decode");
        static_cast<void>(loaded.decoder->take(transfer));
    }
    loaded.file = reader.accounts();
    if (loaded.file.blocks.bytes_total == 0) {
        return Error{ErrorCode::malformed, "read capture '" + path + "': the file is empty"};
    }
    loaded.metadata = reader.metadata();
    loaded.last_checkpoint = reader.checkpoint();
    loaded.marks = reader.marks();
    return loaded;
}

bool looks_like_capture(const std::string& path) {
    if (path.ends_with(".pcapng") || path.ends_with(".pcap")) { return true; }
    // What is read from a pipe is gone for whoever reads it next.
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown)) { return false; }
    constexpr std::array<std::string_view, 3> beginnings{"\x0A\x0D\x0D\x0A", "\xD4\xC3\xB2\xA1",
                                                         "\x4D\x3C\xB2\xA1"};
    std::array<char, 4> begin{};
    std::ifstream file(path, std::ios::binary);
    return file.read(begin.data(), begin.size()) &&
           std::ranges::find(beginnings, std::string_view(begin.data(), begin.size())) != beginnings.end();
}

}  // namespace gyrolog
