// A file of lines that grows while a program works, for whoever reads it meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "host/base/replacing_file.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// Made with the first line, whole; until then, what was there under that name stays. Errors: those of
// write_file().
class LineFile {
public:
    explicit LineFile(std::string path) : path_(std::move(path)) {}

    // `line` with its line break: all of it, or an error and nothing of it. What a full disk took of it is
    // taken back; a pipe keeps what it got.
    Status append(std::string_view line);
    // On the disk.
    Status close();

private:
    Status write_whole(std::string_view line);

    std::string path_;
    std::optional<ReplacingFile> file_;  // from the first line on
    std::uint64_t bytes_ = 0;
};

}  // namespace gyrolog
