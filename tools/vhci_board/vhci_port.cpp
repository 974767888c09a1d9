#include "tools/vhci_board/vhci_port.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace gyrolog {
namespace {

constexpr const char* status_path = "/sys/devices/platform/vhci_hcd.0/status";
constexpr const char* attach_path = "/sys/devices/platform/vhci_hcd.0/attach";

// Numbers of the kernel's usbip_device_status and usb_device_speed.
constexpr int port_free = 4;
constexpr int full_speed = 2;

// A line of the status file is "hs  0003 004 ...": hub, port, state. Ports of the "ss" hub take SuperSpeed
// devices only.
std::optional<unsigned> first_free_port(std::istream& status) {
    std::string line;
    while (std::getline(status, line)) {
        std::istringstream fields(line);
        std::string hub;
        unsigned port = 0;
        int state = 0;
        if (fields >> hub >> port >> state && hub == "hs" && state == port_free) { return port; }
    }
    return std::nullopt;
}

Error attach_error(int number) {
    const std::string message = std::string("attach to vhci_hcd: ") + std::strerror(number);
    if (number == ENOENT) { return {ErrorCode::not_found, message + " (modprobe vhci-hcd)"}; }
    if (number == EACCES || number == EPERM) {
        return {ErrorCode::permission_denied, message + " (run as root)"};
    }
    if (number == EBUSY) { return {ErrorCode::busy, message}; }
    return {ErrorCode::failed, message};
}

// Hands the kernel its end of the socket. 0 or an errno.
int attach(unsigned port, int kernel_socket) {
    const int file = ::open(attach_path, O_WRONLY | O_CLOEXEC);
    if (file < 0) { return errno; }
    // The third number is the device's id on the remote machine. There is none; it must only differ between
    // ports.
    const std::string line = std::to_string(port) + ' ' + std::to_string(kernel_socket) + ' ' +
                             std::to_string(0x10002U + port) + ' ' + std::to_string(full_speed);
    const ssize_t written = ::write(file, line.data(), line.size());
    const int problem = written < 0 ? errno : 0;
    ::close(file);
    return problem;
}

}  // namespace

Result<VhciPort> VhciPort::plug_in(std::optional<unsigned> port) {
    if (!port) {
        std::ifstream status(status_path);
        if (!status) { return attach_error(ENOENT); }
        port = first_free_port(status);
        if (!port) { return Error{ErrorCode::busy, "attach to vhci_hcd: no free port"}; }
    }
    int ends[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) { return attach_error(errno); }
    VhciPort plugged(ends[0], *port);
    const int problem = attach(*port, ends[1]);
    ::close(ends[1]);  // the kernel holds its own reference
    if (problem != 0) { return attach_error(problem); }
    return plugged;
}

VhciPort::VhciPort(VhciPort&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), port_(other.port_) {}

VhciPort& VhciPort::operator=(VhciPort&& other) noexcept {
    std::swap(socket_, other.socket_);
    std::swap(port_, other.port_);
    return *this;
}

VhciPort::~VhciPort() {
    if (socket_ >= 0) { ::close(socket_); }
}

}  // namespace gyrolog
