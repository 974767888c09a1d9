// Standard output as a stream in which text from outside cannot command a terminal, and which remembers why a
// write failed. JSON passes as it is: what is shown otherwise is written the same way in its strings.
#pragma once

#include <array>
#include <ostream>
#include <streambuf>
#include <string_view>

#include "host/app/ink.hpp"
#include "host/base/printable.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

class StandardOutput final : public InkedStream {
public:
    StandardOutput();

    // Writes out what is left. A reader that went away (`| head`) has what it wanted: that is no error.
    // Errors: disk_full, storage_failed.
    Status finish();

private:
    class Buffer final : public std::streambuf {
    public:
        Buffer();
        void write_code(const char* code);
        int problem() const { return problem_; }  // errno of the first write that failed; 0: none

    protected:
        int_type overflow(int_type character) override;
        int sync() override;

    private:
        bool write_out();
        void write_raw(std::string_view text);

        std::array<char, 65536> text_{};
        PrintableText printable_;
        int problem_ = 0;
    };

    void write_code(const char* code) override { buffer_.write_code(code); }

    Buffer buffer_;
};

}  // namespace gyrolog
