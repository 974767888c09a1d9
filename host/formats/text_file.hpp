// Text files by name, compressed or not, as the name's ending says: .xz, .gz, .zst or .bz2.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/replacing_file.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// As every pcapng file does: by its first four bytes.
bool begins_as_capture(std::string_view bytes);

class TextReader {
public:
    // Error malformed where a file's name and its content disagree about its compression. A pipe and standard
    // input have no name that would say it: there the content does.
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
    // A ReplacingFile, put in its place by close().
    whole,
    // Under its own name from the first text on, and handed to the system by every write(): whoever reads it
    // sees it grow, and a failure leaves what came before. Without any text, what was there stays.
    growing,
};

class TextWriter {
public:
    static Result<TextWriter> create(const std::string& path, TextGrowth growth = TextGrowth::whole);
    TextWriter(TextWriter&&) = default;
    TextWriter& operator=(TextWriter&&) = delete;
    // Without close() nothing is left of a whole file.
    ~TextWriter() = default;

    Status write(std::string_view text);
    // The file is whole only after close() said so.
    Status close();

private:
    struct Close {
        void operator()(void* archive) const;
    };
    TextWriter() = default;

    std::optional<ReplacingFile> file_;
    TextGrowth growth_ = TextGrowth::whole;
    bool any_text_ = false;
    std::unique_ptr<void, Close> archive_;
};

}  // namespace gyrolog
