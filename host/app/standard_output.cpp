#include "host/app/standard_output.hpp"

#include <cerrno>

#include <unistd.h>

#include "host/base/storage_error.hpp"

namespace gyrolog {

StandardOutput::Buffer::Buffer() { setp(text_.data(), text_.data() + text_.size()); }

// After a failure nothing more is written: text with a hole in it would be worse than none.
bool StandardOutput::Buffer::write_out() {
    write_raw(printable_.take({pbase(), static_cast<std::size_t>(pptr() - pbase())}));
    setp(text_.data(), text_.data() + text_.size());
    return problem_ == 0;
}

void StandardOutput::Buffer::write_code(const char* code) {
    write_out();
    write_raw(code);
}

void StandardOutput::Buffer::write_raw(std::string_view rest) {
    while (problem_ == 0 && !rest.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, rest.data(), rest.size());
        if (written >= 0) {
            rest.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno != EINTR) {
            problem_ = errno;
        }
    }
}

StandardOutput::Buffer::int_type StandardOutput::Buffer::overflow(int_type character) {
    if (!write_out()) { return traits_type::eof(); }
    return traits_type::eq_int_type(character, traits_type::eof())
               ? traits_type::not_eof(character)
               : sputc(traits_type::to_char_type(character));
}

int StandardOutput::Buffer::sync() { return write_out() ? 0 : -1; }

StandardOutput::StandardOutput() : InkedStream(takes_colour(STDOUT_FILENO)) { rdbuf(&buffer_); }

Status StandardOutput::finish() {
    flush();
    switch (buffer_.problem()) {
        case 0:
        case EPIPE:
            return {};
        default:
            return in_context("write to standard output", storage_error(buffer_.problem()));
    }
}

}  // namespace gyrolog
