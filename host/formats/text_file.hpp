// Text files by name, compressed or not: .xz, .gz, .zst and .bz2 are told by their content when read, and by
// the name's ending when written.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "host/base/result.hpp"

namespace gyrolog {

class TextReader {
public:
    static Result<TextReader> open(const std::string& path);

    // The next piece of the file, valid until the next call; empty at its end.
    Result<std::string_view> read();

private:
    struct Close {
        void operator()(void* archive) const;
    };
    std::unique_ptr<void, Close> archive_;
    std::string buffer_;
};

class TextWriter {
public:
    static Result<TextWriter> create(const std::string& path);

    Status write(std::string_view text);
    // The file is whole only after close() said so.
    Status close();

private:
    struct Close {
        void operator()(void* archive) const;
    };
    std::unique_ptr<void, Close> archive_;
};

}  // namespace gyrolog
