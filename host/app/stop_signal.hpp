// How the program meets the signals that end it.
#pragma once

#include <atomic>

namespace gyrolog {

// SIGINT, SIGTERM, SIGHUP and every other signal that ends a process end the program at once, whatever it is
// doing: what it was writing and is not yet whole is removed, a terminal and serial ports get their modes
// back, and the exit status tells of the signal. SIGQUIT, SIGABRT and a crash give these back as well. A
// signal that was ignored when the program began (nohup, a job in the background) stays ignored.
void install_stop_signals();

// While one lives, the first signal is only noted, and the one who holds it ends tidily: a capture is closed.
// The second ends the program at once.
class TidyEnd {
public:
    TidyEnd();
    TidyEnd(const TidyEnd&) = delete;
    TidyEnd& operator=(const TidyEnd&) = delete;
    ~TidyEnd();
};

// The number of the signal that was noted; 0: none.
const std::atomic<int>& noted_stop_signal();

}  // namespace gyrolog
