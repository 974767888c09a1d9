#include "tools/vhci_board/vhci_connection.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <poll.h>
#include <sys/socket.h>

#include "host/virtual_board/usb_function.hpp"
#include "tools/vhci_board/board_pace.hpp"
#include "tools/vhci_board/urb_server.hpp"
#include "tools/vhci_board/usbip.hpp"
#include "tools/vhci_board/vhci_port.hpp"

namespace gyrolog {
namespace {

// The board is looked at this often: the frame of a full-speed bus.
constexpr int kernel_turn_ms = 1;

// 0 before the first start.
double streaming_s(const VirtualBoard& board) {
    const auto start_ns = board.first_start_ns();
    return start_ns ? static_cast<double>(board.now_ns() - *start_ns) * 1e-9 : 0.0;
}

// False when the kernel's side has closed the link.
Result<bool> receive(int socket, usbip::CommandReader& reader) {
    std::array<std::uint8_t, 65536> bytes{};
    const ssize_t received = ::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (received > 0) { reader.append(ByteView(bytes).first(static_cast<std::size_t>(received))); }
    if (received == 0 || (received < 0 && errno == ECONNRESET)) { return false; }
    if (received < 0 && errno != EAGAIN && errno != EINTR) {
        return Error{ErrorCode::failed, std::string("vhci link: ") + std::strerror(errno)};
    }
    return true;
}

// False when the kernel's side has closed the link. May wait: the kernel always takes replies.
bool send(int socket, ByteView bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno != EINTR) { return false; }
        if (sent > 0) { bytes = bytes.subspan(static_cast<std::size_t>(sent)); }
    }
    return true;
}

}  // namespace

Result<ConnectionEnd> serve_vhci_connection(VirtualBoard& board, std::optional<unsigned> port,
                                            std::vector<LinkFault> faults, SessionLog& log,
                                            const volatile std::sig_atomic_t& stop) {
    GYROLOG_TRY(const VhciPort plugged, VhciPort::plug_in(port));
    UsbFunction function(board);
    UrbServer server(function, std::move(faults));
    BoardPace pace;
    usbip::CommandReader reader;
    while (stop == 0) {
        pollfd wait{plugged.socket(), POLLIN, 0};
        ::poll(&wait, 1, kernel_turn_ms);
        GYROLOG_TRY(const bool attached, receive(plugged.socket(), reader));
        if (!attached) { return ConnectionEnd::detached; }

        pace.catch_up(function, [&] {
            log.observe(board);
            server.serve(streaming_s(board));
        });
        if (function.unplugged()) { return ConnectionEnd::unplugged; }
        for (;;) {
            GYROLOG_TRY(const auto command, reader.next());
            if (!command) { break; }
            server.carry_out(*command);
            log.observe(board);
        }
        server.serve(streaming_s(board));
        if (!send(plugged.socket(), server.take_replies())) { return ConnectionEnd::detached; }
    }
    return ConnectionEnd::stopped;
}

}  // namespace gyrolog
