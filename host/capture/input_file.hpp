// A file to read at any place; small enough to fake.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "host/base/bytes.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

class InputFile {
public:
    virtual ~InputFile() = default;

    // As it was when the file was opened. A file that is still being written is read up to there.
    virtual std::uint64_t size_bytes() const = 0;
    // Fills `out` from `offset`; returns how many bytes there were, fewer only at the end of the file.
    virtual Result<std::size_t> read_at(std::uint64_t offset, std::span<std::uint8_t> out) = 0;
};

// Errors: not_found, permission_denied, failed; unsupported for what is not a regular file.
Result<std::unique_ptr<InputFile>> open_input_file(const std::string& path);
std::unique_ptr<InputFile> input_from_memory(Bytes contents);

}  // namespace gyrolog
