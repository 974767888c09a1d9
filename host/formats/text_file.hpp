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

// How a file comes to be.
enum class TextGrowth {
    // Written beside the file that it shall be and put in its place by close(), so that a failure leaves what
    // was there. A path that is no regular file (a pipe, /dev/stdout) is written directly.
    whole,
    // Under its own name from the first byte, and handed to the system by every write(): whoever reads it
    // sees it grow, and a failure leaves what came before.
    growing,
};

class TextWriter {
public:
    static Result<TextWriter> create(const std::string& path, TextGrowth growth = TextGrowth::whole);
    TextWriter(TextWriter&&) = default;
    TextWriter& operator=(TextWriter&&) = delete;
    // Without close() nothing is left of a whole file.
    ~TextWriter();

    Status write(std::string_view text);
    // The file is whole only after close() said so.
    Status close();

private:
    struct Close {
        void operator()(void* archive) const;
    };
    TextWriter() = default;

    std::unique_ptr<void, Close> archive_;
    std::string path_;
    std::string beside_;  // where it is written until then; empty: at path_
};

}  // namespace gyrolog
