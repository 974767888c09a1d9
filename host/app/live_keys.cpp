#include "host/app/live_keys.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>

#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace gyrolog {
namespace {

constexpr char escape = '\x1b';

// Length of the escape sequence that `text` begins with; 1 for the Escape key itself.
std::size_t escape_length(std::string_view text) {
    if (text.size() < 2 || (text[1] != '[' && text[1] != 'O')) { return 1; }
    std::size_t at = 2;
    while (at < text.size() && (text[at] < '@' || text[at] > '~')) { ++at; }
    return std::min(at + 1, text.size());
}

// A job in the background is stopped by the kernel when it touches its terminal.
bool in_foreground() { return isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp(); }

// The terminal is the process's: it has one mode, whoever looks at it, and a signal handler may restore it.
termios found_mode{};
std::atomic<bool> mode_changed = false;
std::atomic<bool> given_back = false;

}  // namespace

void LiveKeys::take(std::string_view typed, HostTime now) {
    while (!typed.empty()) {
        const std::size_t length = typed.front() == escape ? escape_length(typed) : 1;
        if (typed.front() == escape && length == 1) {
            note_.reset();
        } else if (typed.front() != escape && note_) {
            take_text(typed.front());
        } else if (typed.front() != escape) {
            take_command(typed.front(), now);
        }
        typed.remove_prefix(length);
    }
}

void LiveKeys::take_command(char key, HostTime now) {
    switch (key) {
        case 'm':
            note_.emplace();
            note_begun_ = now;
            break;
        case 's':
            control_.set_streaming(!control_.streaming_wanted());
            break;
        case 'q':
            end_wanted_ = true;
            break;
        default:
            break;
    }
}

void LiveKeys::take_text(char byte) {
    constexpr char backspace = '\b';
    constexpr char erase = '\x7f';
    constexpr char erase_all = '\x15';
    if (byte == '\r' || byte == '\n') {
        finish();
    } else if (byte == backspace || byte == erase) {
        while (!note_->empty()) {
            const bool begins_character = (static_cast<unsigned char>(note_->back()) & 0xC0U) != 0x80U;
            note_->pop_back();
            if (begins_character) { break; }
        }
    } else if (byte == erase_all) {
        note_->clear();
    } else if (static_cast<unsigned char>(byte) >= 0x20U && note_->size() < note_bytes_max) {
        note_->push_back(byte);
    }
}

void LiveKeys::finish() {
    if (note_) { control_.mark(*note_, note_begun_); }
    note_.reset();
}

void give_terminal_back() {
    const int interrupted_errno = errno;
    given_back = true;
    if (mode_changed && in_foreground()) { tcsetattr(STDIN_FILENO, TCSANOW, &found_mode); }
    errno = interrupted_errno;
}

TerminalKeys::~TerminalKeys() {
    if (mode_changed && in_foreground()) { tcsetattr(STDIN_FILENO, TCSANOW, &found_mode); }
    mode_changed = false;
}

// Also after the shell has put its own mode back, when the program was stopped and goes on.
bool TerminalKeys::take_over() {
    if (given_back || !in_foreground()) { return false; }
    termios mode{};
    if (tcgetattr(STDIN_FILENO, &mode) != 0) { return false; }
    if ((mode.c_lflag & static_cast<tcflag_t>(ICANON)) == 0) { return true; }
    if (!mode_changed) { found_mode = mode; }
    mode.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    mode.c_cc[VMIN] = 0;
    mode.c_cc[VTIME] = 0;
    mode_changed = tcsetattr(STDIN_FILENO, TCSANOW, &mode) == 0;
    // A signal in between has given back what was not taken yet.
    if (given_back && mode_changed) {
        tcsetattr(STDIN_FILENO, TCSANOW, &found_mode);
        return false;
    }
    return mode_changed;
}

std::string TerminalKeys::read() {
    std::string typed;
    if (!take_over()) { return typed; }
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, 0) <= 0 || (input.revents & POLLIN) == 0) { return typed; }
    std::array<char, 256> bytes{};
    const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count > 0) { typed.assign(bytes.data(), static_cast<std::size_t>(count)); }
    return typed;
}

}  // namespace gyrolog
