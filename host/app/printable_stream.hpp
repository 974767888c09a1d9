// A stream for messages, in which text from outside cannot command the terminal.
#pragma once

#include <ostream>
#include <streambuf>

#include "host/app/ink.hpp"
#include "host/base/printable.hpp"

namespace gyrolog {

// Lines and tabs pass; what else a terminal would obey is shown (PrintableText).
class PrintableStream final : public InkedStream {
public:
    explicit PrintableStream(std::ostream& to, bool has_colour = false)
        : InkedStream(has_colour), to_(to), buffer_(to) {
        rdbuf(&buffer_);
    }

private:
    void write_code(const char* code) override { to_ << code; }

    class Buffer final : public std::streambuf {
    public:
        explicit Buffer(std::ostream& to) : to_(to) {}

    protected:
        int_type overflow(int_type character) override {
            if (traits_type::eq_int_type(character, traits_type::eof())) { return character; }
            const char byte = traits_type::to_char_type(character);
            return xsputn(&byte, 1) == 1 ? character : traits_type::eof();
        }
        std::streamsize xsputn(const char* text, std::streamsize size) override {
            to_ << text_.take({text, static_cast<std::size_t>(size)});
            return to_.good() ? size : 0;
        }
        int sync() override {
            to_.flush();
            return to_.good() ? 0 : -1;
        }

    private:
        std::ostream& to_;
        PrintableText text_;
    };

    std::ostream& to_;
    Buffer buffer_;
};

}  // namespace gyrolog
