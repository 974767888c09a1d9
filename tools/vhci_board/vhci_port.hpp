// A place on the kernel's virtual host controller (vhci_hcd): the kernel takes what is plugged in there for a
// full-speed USB device and talks USB/IP to it over a socket. Needs root and the module vhci-hcd; no network,
// no usbip tool.
#pragma once

#include <optional>

#include "host/base/result.hpp"

namespace gyrolog {

class VhciPort {
public:
    // Plugs in at `port`, or at the first free one. From here on the kernel enumerates the device: its
    // commands must be answered. Errors: not_found (no vhci_hcd), permission_denied, busy (no free port),
    // failed.
    static Result<VhciPort> plug_in(std::optional<unsigned> port);

    VhciPort(VhciPort&& other) noexcept;
    VhciPort& operator=(VhciPort&& other) noexcept;
    VhciPort(const VhciPort&) = delete;
    VhciPort& operator=(const VhciPort&) = delete;
    // Closes the socket, which is how the kernel learns that the device was pulled out.
    ~VhciPort();

    int socket() const { return socket_; }  // of the device's side
    unsigned port() const { return port_; }

private:
    VhciPort(int socket, unsigned port) : socket_(socket), port_(port) {}

    int socket_ = -1;
    unsigned port_ = 0;
};

}  // namespace gyrolog
