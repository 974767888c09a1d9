// What a key does while a capture runs: m marks, s stops the board and starts it again, q ends the capture.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/base/clock.hpp"
#include "host/session/capture_control.hpp"

namespace gyrolog {

class LiveKeys {
public:
    explicit LiveKeys(CaptureControl& control) : control_(control) {}

    // As the terminal delivers them: text is UTF-8, a key that is no character is an escape sequence.
    //
    // m begins a mark, whose time is that of the key; what follows up to Enter is its text; Escape drops it.
    void take(std::string_view typed, HostTime now = host_now());
    // The capture ends: a mark that is being written counts as finished.
    void finish();

    bool end_wanted() const { return end_wanted_; }
    // Of the mark that is being written.
    const std::optional<std::string>& note() const { return note_; }

private:
    void take_command(char key, HostTime now);
    void take_text(char byte);

    static constexpr std::size_t note_bytes_max = 500;

    CaptureControl& control_;
    std::optional<std::string> note_;
    HostTime note_begun_;
    bool end_wanted_ = false;
};

// Keys without echo and without waiting for Enter, for as long as this lives. Where standard input is no
// terminal, or this program is not in its foreground, there are none.
class TerminalKeys {
public:
    TerminalKeys() = default;
    TerminalKeys(const TerminalKeys&) = delete;
    TerminalKeys& operator=(const TerminalKeys&) = delete;
    ~TerminalKeys();

    // What has been typed; never waits. Comes back to its own mode after a stop by the shell.
    std::string read();

private:
    bool take_over();
};

// Gives the terminal back for good, for a signal handler: the next signal may end the program at once.
void give_terminal_back();

}  // namespace gyrolog
