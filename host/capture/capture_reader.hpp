// Reads a capture file, transfer by transfer: one of this program's, or one that tcpdump, dumpcap or
// Wireshark recorded on usbmon (pcapng or classic pcap, link type 220), of whose devices the board is picked.
//
//     GYROLOG_TRY(CaptureReader reader, CaptureReader::open(path));
//     while (true) {
//         GYROLOG_TRY(const std::optional<CapturedTransfer> captured, reader.next());
//         if (!captured) { break; }
//         decoder.feed(captured->transfer.data, captured->transfer.time);
//     }
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/base/result.hpp"
#include "host/capture/block_scanner.hpp"
#include "host/capture/capture_metadata.hpp"
#include "host/capture/input_file.hpp"
#include "host/capture/usbmon_record.hpp"
#include "host/transport/transfer.hpp"

namespace gyrolog {

// `transfer.data` is valid until the next call of next().
struct CapturedTransfer {
    Transfer transfer;
    std::uint64_t offset = 0;  // of its block in the file
};

struct CaptureAccounts {
    BlockAccounts blocks;  // file bytes, damage, end
    std::uint64_t transfers = 0;
    std::uint64_t stream_bytes = 0;         // data of bulk IN completions
    std::uint64_t failed_transfers = 0;     // completions with an error status
    std::uint64_t truncated_transfers = 0;  // a foreign capture kept only their first bytes: the rest is lost
    std::uint64_t foreign_packets = 0;      // of other devices or endpoints, or not USB at all
};

class CaptureReader {
public:
    // Reads a foreign capture once through to find the board: the device with its identifiers, or else the
    // one with the most bulk IN data. Errors: those of open_input_file; malformed, unsupported (see
    // BlockScanner::next); not_found when a foreign capture holds no bulk IN data.
    static Result<CaptureReader> open(const std::string& path);
    static Result<CaptureReader> open(std::unique_ptr<InputFile> file);

    // What the file's section header says. No value in a foreign capture, or when it is damaged.
    const std::optional<CaptureMetadata>& metadata() const { return metadata_; }
    // Of a foreign capture: which device was picked.
    const std::optional<UsbAddress>& picked_device() const { return picked_; }
    // The checkpoint read last.
    const std::optional<CaptureCheckpoint>& checkpoint() const { return checkpoint_; }
    // Those read so far, the first hundred thousand.
    const std::vector<CaptureMark>& marks() const { return marks_; }

    // The next transfer, or nothing at the end. Error `failed`: the file could not be read.
    Result<std::optional<CapturedTransfer>> next();

    // Complete once next() has returned nothing.
    CaptureAccounts accounts() const;

private:
    explicit CaptureReader(std::unique_ptr<InputFile> file) : scanner_(std::move(file)) {}

    Status pick_device();
    Result<std::optional<CapturedTransfer>> advance();
    void enter_section(const CaptureBlock& block);
    void enter_statistics(const CaptureBlock& block);
    std::optional<CapturedTransfer> take_packet(const CaptureBlock& block);

    BlockScanner scanner_;
    std::optional<CaptureMetadata> metadata_;
    std::optional<CaptureCheckpoint> checkpoint_;
    std::vector<CaptureMark> marks_;
    std::optional<UsbAddress> picked_;
    std::uint8_t picked_endpoint_ = 0;
    std::int64_t monotonic_behind_ns_ = 0;   // real time less monotonic time in the present section
    std::optional<CapturedTransfer> first_;  // read ahead by open()
    CaptureAccounts accounts_;
};

}  // namespace gyrolog
