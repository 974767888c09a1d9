// Where a command speaks: results on `out`, which may be piped, everything else on `err`.
#pragma once

#include <atomic>
#include <ostream>
#include <string>

namespace gyrolog {

struct Console {
    std::ostream& out;                         // the result and nothing else
    std::ostream& err;                         // messages, warnings, errors
    bool progress = false;                     // err is a terminal: a line may be redrawn
    const std::atomic<int>* signal = nullptr;  // set to the signal's number once the user wants to stop
    std::ostream* screen = nullptr;            // the terminal behind err, which obeys
    std::string* told_error = nullptr;         // what report_error() says is noted here, too
    bool is_quiet = false;                     // no notices

    // For lines that are redrawn. What comes from outside goes there as printable() only.
    std::ostream& drawing() const { return screen == nullptr ? err : *screen; }
    // For what tells how it went: files that were written, what a simulation has. Warnings and errors go to
    // `err`.
    std::ostream& notices() const;
    bool stop_wanted() const { return signal != nullptr && signal->load() != 0; }
};

}  // namespace gyrolog
