#include "host/session/load_capture.hpp"

#include <array>
#include <fstream>

namespace gyrolog {

Result<LoadedCapture> load_capture(const std::string& path, bool keep_samples) {
    GYROLOG_TRY(CaptureReader reader, CaptureReader::open(path));
    LoadedCapture loaded;
    loaded.decoder = std::make_unique<StreamDecoder>(
        StreamDecoderOptions{.keep_samples = keep_samples, .observer = nullptr});
    bool any_data = false;
    while (true) {
        GYROLOG_TRY(const std::optional<CapturedTransfer> captured, reader.next());
        if (!captured) { break; }
        const Transfer& transfer = captured->transfer;
        if (!any_data && transfer.carries_stream() && !transfer.data.empty()) {
            loaded.first_data = transfer.time;
            any_data = true;
        }
        static_cast<void>(loaded.decoder->take(transfer));
    }
    loaded.file = reader.accounts();
    loaded.metadata = reader.metadata();
    loaded.last_checkpoint = reader.checkpoint();
    return loaded;
}

bool looks_like_capture(const std::string& path) {
    std::array<char, 4> begin{};
    std::ifstream file(path, std::ios::binary);
    if (!file.read(begin.data(), begin.size())) { return false; }
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(begin[i]); };
    const bool pcapng = byte(0) == 0x0A && byte(1) == 0x0D && byte(2) == 0x0D && byte(3) == 0x0A;
    const bool pcap = (byte(0) == 0xD4 && byte(1) == 0xC3 && byte(2) == 0xB2 && byte(3) == 0xA1) ||
                      (byte(0) == 0x4D && byte(1) == 0x3C && byte(2) == 0xB2 && byte(3) == 0xA1);
    return pcapng || pcap || path.ends_with(".pcapng") || path.ends_with(".pcap");
}

}  // namespace gyrolog
