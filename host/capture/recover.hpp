// The intact part of a damaged capture, as a new file.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"
#include "host/capture/block_scanner.hpp"
#include "host/capture/input_file.hpp"

namespace gyrolog {

struct RecoveryReport {
    BlockAccounts source;           // what was found in the damaged file, and what was left out
    std::uint64_t bytes_kept = 0;   // length of the new file
    bool header_rewritten = false;  // the section header was lost: who was captured is no longer known
};

using ByteWriter = std::function<Status(ByteView)>;

// Copies every intact block, byte for byte. A capture without damage is copied as it is. Errors: those of
// reading and of writing; invalid_argument when the new file exists; malformed when nothing is intact. After
// an error there is no new file.
Result<RecoveryReport> recover_capture(const std::string& damaged_path, const std::string& recovered_path);
Result<RecoveryReport> recover_capture(std::unique_ptr<InputFile> damaged, const ByteWriter& write);

}  // namespace gyrolog
