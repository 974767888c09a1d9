#include "tools/vhci_board/tty_connection.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <gyrolog_protocol/usb_identity.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "host/virtual_board/usb_function.hpp"
#include "tools/vhci_board/board_pace.hpp"
#include "tools/vhci_board/line_state_trace.hpp"

namespace gyrolog {
namespace {

constexpr int turn_ms = 1;
constexpr int reopen_ms = 100;

class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    ~Descriptor() {
        if (number_ >= 0) { ::close(number_); }
    }
    int number() const { return number_; }

private:
    int number_ = -1;
};

Result<Descriptor> open_for_polling(const std::string& path, int flags) {
    Descriptor file(::open(path.c_str(), flags | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (file.number() < 0) {
        return Error{ErrorCode::failed, "open '" + path + "': " + std::strerror(errno)};
    }
    return file;
}

Result<Descriptor> open_tty(const std::string& path) {
    GYROLOG_TRY(Descriptor tty, open_for_polling(path, O_RDWR));
    termios settings{};
    if (::tcgetattr(tty.number(), &settings) == 0) {
        ::cfmakeraw(&settings);
        if (::tcsetattr(tty.number(), TCSANOW, &settings) == 0) { return tty; }
    }
    return Error{ErrorCode::failed, "set up '" + path + "': " + std::strerror(errno)};
}

// The board's requests and endpoints, played by hand: what the gadget stack would pass on.
class TtyFeeder {
public:
    TtyFeeder(VirtualBoard& board, SessionLog& log) : board_(board), function_(board), log_(log) {}

    // Runs the board up to now and writes what it sends, as much as the terminal takes. False when that has
    // hung up.
    bool advance(int tty) {
        bool connected = true;
        pace_.catch_up(function_, [&] {
            log_.observe(board_);
            connected = connected && write_stream(tty);
        });
        return connected;
    }

    void set_line_state(unsigned value) {
        function_.control(
            {0x21, GLP_CDC_SET_CONTROL_LINE_STATE, static_cast<std::uint8_t>(value), 0, 0, 0, 0, 0}, {});
        log_.observe(board_);
    }

    // All the text there is.
    void read_line_state(int trace) {
        std::array<char, 4096> text{};
        for (;;) {
            const ssize_t size = ::read(trace, text.data(), text.size());
            if (size <= 0) { return; }
            for (const unsigned value : trace_.append({text.data(), static_cast<std::size_t>(size)})) {
                set_line_state(value);
            }
        }
    }

    // False when the terminal has hung up.
    bool read_commands(int tty) {
        std::array<std::uint8_t, 512> bytes{};
        const ssize_t size = ::read(tty, bytes.data(), bytes.size());
        if (size > 0) {
            function_.bulk_out(ByteView(bytes).first(static_cast<std::size_t>(size)));
            log_.observe(board_);
        }
        return size > 0 || (size < 0 && (errno == EAGAIN || errno == EINTR));
    }

    // The host is gone, and with it the state of the line.
    void hang_up() {
        set_line_state(0);
        waiting_ = {};
        function_.bus_reset();
    }

private:
    // False when the terminal has hung up.
    bool write_stream(int tty) {
        for (;;) {
            if (waiting_.empty()) {
                const auto size = function_.bulk_in(packet_);
                if (!size) { return true; }
                waiting_ = ByteView(packet_).first(*size);
                continue;
            }
            const ssize_t written = ::write(tty, waiting_.data(), waiting_.size());
            if (written < 0) { return errno == EAGAIN || errno == EINTR; }
            if (written == 0) { return true; }
            waiting_ = waiting_.subspan(static_cast<std::size_t>(written));
        }
    }

    VirtualBoard& board_;
    UsbFunction function_;
    BoardPace pace_;
    SessionLog& log_;
    LineStateTrace trace_;
    std::array<std::uint8_t, GLP_USB_PACKET_BYTES> packet_{};
    ByteView waiting_;  // of packet_, not yet taken by the terminal
};

}  // namespace

Status serve_tty_connection(VirtualBoard& board, const std::string& tty_path,
                            const std::string& line_state_path, SessionLog& log,
                            const volatile std::sig_atomic_t& stop) {
    GYROLOG_TRY(const Descriptor trace, open_for_polling(line_state_path, O_RDONLY));
    GYROLOG_TRY(Descriptor tty, open_tty(tty_path));
    TtyFeeder feeder(board, log);
    while (stop == 0) {
        std::array<pollfd, 2> wait = {{{tty.number(), POLLIN, 0}, {trace.number(), POLLIN, 0}}};
        ::poll(wait.data(), wait.size(), turn_ms);
        feeder.read_line_state(trace.number());
        if (feeder.read_commands(tty.number()) && feeder.advance(tty.number())) { continue; }
        feeder.hang_up();
        ::poll(nullptr, 0, reopen_ms);
        GYROLOG_TRY(tty, open_tty(tty_path));
    }
    return {};
}

}  // namespace gyrolog
