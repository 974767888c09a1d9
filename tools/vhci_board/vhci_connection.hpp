// A board plugged into vhci_hcd, in real time, until it is pulled out or the user stops it.
#pragma once

#include <csignal>
#include <optional>
#include <vector>

#include "host/base/result.hpp"
#include "host/virtual_board/virtual_board.hpp"
#include "tools/vhci_board/link_fault.hpp"
#include "tools/vhci_board/session_log.hpp"

namespace gyrolog {

enum class ConnectionEnd {
    stopped,    // by the user's signal
    unplugged,  // the board left the bus
    detached,   // by the kernel's side
};

// Plugs the board in at `port` (the first free one unless given) and serves it. When this returns the board
// is unplugged. `stop` is set by a signal handler.
Result<ConnectionEnd> serve_vhci_connection(VirtualBoard& board, std::optional<unsigned> port,
                                            std::vector<LinkFault> faults, SessionLog& log,
                                            const volatile std::sig_atomic_t& stop);

}  // namespace gyrolog
