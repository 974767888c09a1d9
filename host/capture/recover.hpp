// The intact part of a damaged capture, as a new file.
#pragma once

#include <memory>
#include <string>

#include "host/base/result.hpp"
#include "host/capture/append_file.hpp"
#include "host/capture/block_scanner.hpp"
#include "host/capture/input_file.hpp"

namespace gyrolog {

struct RecoveryReport {
    BlockAccounts source;           // what was found in the damaged file, and what was left out
    std::uint64_t bytes_kept = 0;   // length of the new file
    bool header_rewritten = false;  // the section header was lost: who was captured is no longer known
};

// Copies every intact block, byte for byte. Errors: those of reading and of creating; the new file is not
// overwritten when it exists. A capture without damage is copied as it is.
Result<RecoveryReport> recover_capture(const std::string& damaged_path, const std::string& recovered_path);
Result<RecoveryReport> recover_capture(std::unique_ptr<InputFile> damaged, AppendFile& recovered);

}  // namespace gyrolog
