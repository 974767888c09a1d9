// A board behind the device side of a serial gadget (ttyGS0), in real time, until the user stops it.
#pragma once

#include <csignal>
#include <string>

#include "host/base/result.hpp"
#include "host/virtual_board/virtual_board.hpp"
#include "tools/vhci_board/session_log.hpp"

namespace gyrolog {

// `line_state_path`: a trace_pipe with the probe that LineStateTrace reads. The terminal hangs up when the
// host is gone; it is opened again for the next one, with DTR low until that host raises it.
Status serve_tty_connection(VirtualBoard& board, const std::string& tty_path,
                            const std::string& line_state_path, SessionLog& log,
                            const volatile std::sig_atomic_t& stop);

}  // namespace gyrolog
