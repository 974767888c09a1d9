// A stored capture, all of its files, read and decoded once: what info, check and every analysis start from.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/recording/stage_observer.hpp"
#include "host/base/result.hpp"
#include "host/capture/capture_reader.hpp"
#include "host/decode/stream_decoder.hpp"

namespace gyrolog {

struct LoadedCapture {
    std::vector<std::string> files;           // one, or all those of a capture of several (segment_files.hpp)
    CaptureAccounts file;                     // of all of them together
    std::optional<CaptureMetadata> metadata;  // absent in a foreign capture
    std::optional<CaptureCheckpoint> last_checkpoint;  // of the last file
    std::vector<CaptureMark> marks;                    // in the order of the files
    // By the writer's own checkpoints: bytes of the stream that it put into the files and that are not there.
    std::uint64_t stream_bytes_gone = 0;
    // How the writer's counters at its checkpoints contradict what was decoded up to there; empty where
    // something of the stream is gone. The first that was found of each kind.
    std::vector<std::string> contradictions_of_writer;
    HostTime first_data;  // arrival of the first stream bytes
    std::unique_ptr<StreamDecoder> decoder;

    // Those of the board (contradiction.hpp), and of the writer.
    std::vector<std::string> contradictions() const;

    // Whether the program that wrote the last file also closed it; true where a foreign program cannot have
    // said so. Of a capture that was read to its end.
    bool closed_by_writer() const { return !metadata || (last_checkpoint && last_checkpoint->last); }
};

// Of samples that are kept.
struct KeptRows {
    std::size_t samples_most = std::numeric_limits<std::size_t>::max();  // reading ends soon after so many
    std::size_t samples_per_row = 1;                                     // more: means of so many
    bool with_accelerometer = true;
};

// Told now and then how large a share of the files has been read.
using ShareObserver = std::function<void(double)>;

// Errors: those of CaptureReader. A capture without one good frame is no error.
// Stages: "read", "decode", by turns.
Result<LoadedCapture> load_capture(const std::string& path, bool keep_samples,
                                   const StageObserver& on_stage = {}, const KeptRows& kept = {},
                                   const ShareObserver& on_share = {});

// Whether the file begins like a capture (pcapng or pcap) rather than like text. False when it cannot be
// read.
bool looks_like_capture(const std::string& path);

}  // namespace gyrolog
