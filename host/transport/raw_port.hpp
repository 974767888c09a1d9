// A serial port that passes every byte as it comes, for as long as it is open.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "host/base/result.hpp"

namespace gyrolog {

// In baud. Without one the port keeps its present speed: it means nothing to a board on USB.
using TtySpeed = std::optional<unsigned>;

// The settings that the port had are put back when it is closed, and by restore_ports(). Beyond 16 ports at
// once there is no room for what the latter needs.
class RawPort {
public:
    // Nobody but root can open it meanwhile. Errors: not_found, permission_denied, busy; invalid_argument
    // when the path is not a terminal or has not this speed.
    static Result<RawPort> open(const std::string& path, TtySpeed speed);
    RawPort(RawPort&&) noexcept;
    RawPort& operator=(RawPort&&) = delete;
    ~RawPort();

    int descriptor() const;

private:
    struct State;
    explicit RawPort(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

// Gives all open ports the settings that they had, for a signal that ends the program at once.
// Async-signal-safe.
void restore_ports() noexcept;

}  // namespace gyrolog
