// A stored capture, read and decoded once: what info, check and every analysis start from.
#pragma once

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
    CaptureAccounts file;
    std::optional<CaptureMetadata> metadata;  // absent in a foreign capture
    std::optional<CaptureCheckpoint> last_checkpoint;
    std::vector<CaptureMark> marks;  // in the order of the file
    HostTime first_data;             // arrival of the first stream bytes
    std::unique_ptr<StreamDecoder> decoder;
};

// Errors: those of CaptureReader. A capture without one good frame is no error.
// Stages: "read", "decode", by turns.
Result<LoadedCapture> load_capture(const std::string& path, bool keep_samples,
                                   const StageObserver& on_stage = {});

// Whether the file begins like a capture (pcapng or pcap) rather than like text. False when it cannot be
// read.
bool looks_like_capture(const std::string& path);

}  // namespace gyrolog
