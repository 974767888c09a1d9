// A port's firmware as a USB device of this machine: its code and its part's USB controller, native, behind
// the kernel's virtual host controller. Needs root and the module vhci-hcd; then `gyrolog --device usb:`
// finds it like any board.
//
// The kernel keeps reset and address of a device behind vhci_hcd to itself: this program does both for it.
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <poll.h>
#include <sys/socket.h>

#include <CLI/CLI.hpp>

#include "host/base/clock.hpp"
#include "tests/native_firmware/native_board.hpp"
#include "tests/native_firmware/usb_host.hpp"
#include "tools/vhci_board/session_log.hpp"
#include "tools/vhci_board/usbip.hpp"
#include "tools/vhci_board/vhci_port.hpp"

namespace gyrolog {
namespace {

volatile std::sig_atomic_t stop_signal = 0;

constexpr std::uint8_t notification_in = 0x81;
constexpr std::uint8_t address = 1;
// Of this program's own requests: the kernel counts its transfers from 1.
constexpr std::uint32_t own_id = 0;
constexpr std::int64_t step_ns = 1'000'000;
// A board that the machine cannot run as fast as time passes falls behind the host: its clock then runs slow.
constexpr std::int64_t lag_max_ns = 50'000'000;

struct Options {
    std::string serial = "A1B2C3D40102030405060708090A0B0C";
    std::string report_path;
    std::optional<double> unplug_after_s;
    std::optional<double> replug_after_s;
    std::optional<double> reset_after_s;
    std::optional<double> suspend_after_s;
    std::optional<double> resume_after_s;
};

std::array<std::uint8_t, GLP_UID_BYTES> uid_of(const std::string& serial) {
    std::array<std::uint8_t, GLP_UID_BYTES> uid{};
    for (std::size_t i = 0; i < uid.size(); ++i) {
        uid[i] = static_cast<std::uint8_t>(std::stoul(serial.substr(2 * i, 2), nullptr, 16));
    }
    return uid;
}

// Something that happens once, so long after the stream's start.
class Planned {
public:
    explicit Planned(std::optional<double> at_s) : at_s_(at_s) {}
    bool due(double streaming_s) {
        if (!at_s_ || streaming_s < *at_s_) { return false; }
        at_s_.reset();
        return true;
    }

private:
    std::optional<double> at_s_;
};

class Bridge {
public:
    explicit Bridge(const Options& options)
        : options_(options),
          board_({.uid = uid_of(options.serial)}),
          host_(board_.processor(), board_.usb(), notification_in),
          unplug_(options.unplug_after_s),
          reset_(options.reset_after_s),
          suspend_(options.suspend_after_s) {
        board_.processor().add_surroundings(host_);
    }

    Status run() {
        while (stop_signal == 0) {
            GYROLOG_CHECK(plug_in());
            GYROLOG_CHECK(serve());
            if (stop_signal != 0 || !unplugged_ || !options_.replug_after_s) { break; }
            rest_s(*options_.replug_after_s);
        }
        if (!board_.processor().complaints().empty()) {
            return Error{ErrorCode::failed, "the part forbids: " + board_.processor().complaints().front()};
        }
        if (options_.report_path.empty()) { return {}; }
        return write_report(options_.report_path, options_.serial, log_.sessions());
    }

private:
    // In step with the host's clock.
    void catch_up() {
        const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
        if (host_ns_ == 0 || now_ns - host_ns_ > lag_max_ns) { host_ns_ = now_ns - step_ns; }
        while (host_ns_ < now_ns) {
            host_ns_ += step_ns;
            advance(step_ns);
        }
    }

    void advance(std::int64_t duration_ns) {
        Processor& processor = board_.processor();
        processor.run_until(processor.now_ticks() + processor.from_ns(duration_ns));
        log_.observe(board_.firmware());
        if (board_.firmware().streaming && !first_start_ticks_) {
            first_start_ticks_ = processor.now_ticks();
        }
    }

    double streaming_s() const {
        if (!first_start_ticks_) { return -1.0; }
        return 1e-9 * static_cast<double>(processor_ns() - board_ns(*first_start_ticks_));
    }
    std::int64_t board_ns(std::uint64_t ticks) const {
        return static_cast<std::int64_t>(ticks * 1000U / part_ticks_per_us);
    }
    std::int64_t processor_ns() const { return board_ns(the_processor().now_ticks()); }

    void rest_s(double duration_s) {
        const std::int64_t end_ns = clock_ns(CLOCK_MONOTONIC) + static_cast<std::int64_t>(duration_s * 1e9);
        while (stop_signal == 0 && clock_ns(CLOCK_MONOTONIC) < end_ns) {
            ::poll(nullptr, 0, 1);
            catch_up();
        }
    }

    // The requests that the kernel does not hand on to a device behind vhci_hcd.
    Status request_at_address_0() {
        host_.reset();
        constexpr int steps = 100;
        bool sent = false;
        for (int i = 0; i < steps; ++i) {
            advance(step_ns);
            if (i < steps / 4) { continue; }  // reset and recovery
            if (!sent) {
                UsbTransfer request;
                request.id = own_id;
                request.setup = {0, 5, address, 0, 0, 0, 0, 0};
                host_.submit(request);
                sent = true;
            }
            for (const UsbTransferEnd& end : host_.take_ended()) {
                if (end.id == own_id && end.status == 0) { return {}; }
                answer(end);
            }
        }
        return Error{ErrorCode::failed, "the firmware does not take an address"};
    }

    Status plug_in() {
        unplugged_ = false;
        // The kernel has given up what was under way when the cable was pulled: an answer to it would end the
        // new link.
        static_cast<void>(host_.take_ended());
        replies_.clear();
        reader_ = {};
        host_.plug(true);
        constexpr int power_on_steps = 1000;
        for (int i = 0; i < power_on_steps && !board_.usb().attached(); ++i) { advance(step_ns); }
        return request_at_address_0();
    }

    // False when the kernel's side has closed the link.
    bool receive(int socket) {
        std::array<std::uint8_t, 65536> bytes{};
        const ssize_t received = ::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (received > 0) { reader_.append(ByteView(bytes).first(static_cast<std::size_t>(received))); }
        return received > 0 || (received < 0 && (errno == EAGAIN || errno == EINTR));
    }

    void carry_out(const usbip::Command& command) {
        if (const auto* unlink = std::get_if<usbip::Unlink>(&command)) {
            const bool given_up = host_.give_up(unlink->target);
            // First what the transfer ended with, if it has: by the other reply the kernel forgets it.
            reply();
            usbip::append_unlink_reply(replies_, unlink->sequence, given_up ? -ECONNRESET : 0);
            return;
        }
        const auto& submit = std::get<usbip::Submit>(command);
        UsbTransfer transfer;
        transfer.id = submit.sequence;
        transfer.endpoint = static_cast<std::uint8_t>(submit.endpoint | (submit.in ? 0x80U : 0U));
        transfer.setup = submit.setup;
        transfer.out_data = submit.data;
        transfer.in_bytes = submit.in ? submit.requested_bytes : 0;
        if (submit.endpoint == 0 && submit.setup[1] == 9 && submit.setup[0] == 0) {
            configuration_ = submit.setup;
        }
        host_.submit(std::move(transfer));
    }

    void reply() {
        for (const UsbTransferEnd& end : host_.take_ended()) { answer(end); }
    }

    void answer(const UsbTransferEnd& end) {
        if (end.id == own_id) { return; }
        const std::size_t actual = end.in_data.empty() ? end.out_bytes : end.in_data.size();
        usbip::append_submit_reply(replies_, end.id, end.status, static_cast<std::uint32_t>(actual),
                                   end.in_data);
    }

    bool send(int socket) {
        const Bytes replies = std::exchange(replies_, {});
        for (ByteView rest = replies; !rest.empty();) {
            const ssize_t sent = ::send(socket, rest.data(), rest.size(), MSG_NOSIGNAL);
            if (sent < 0 && errno != EINTR) { return false; }
            if (sent > 0) { rest = rest.subspan(static_cast<std::size_t>(sent)); }
        }
        return true;
    }

    Status meet_plans() {
        if (unplug_.due(streaming_s())) {
            host_.plug(false);
            unplugged_ = true;
        }
        if (suspend_.due(streaming_s())) {
            host_.suspend(true);
            rest_s(options_.resume_after_s.value_or(1.0));
            host_.suspend(false);
        }
        if (reset_.due(streaming_s())) {
            // As the kernel's hub driver takes a device up again that was reset: address and configuration,
            // and the transfers that were under way have failed.
            reply();
            GYROLOG_CHECK(request_at_address_0());
            UsbTransfer again;
            again.setup = configuration_;
            again.id = own_id;
            host_.submit(again);
        }
        return {};
    }

    Status serve() {
        GYROLOG_TRY(const VhciPort port, VhciPort::plug_in(std::nullopt));
        while (stop_signal == 0) {
            pollfd wait{port.socket(), POLLIN, 0};
            ::poll(&wait, 1, 1);
            if (!receive(port.socket())) { return {}; }
            for (;;) {
                GYROLOG_TRY(const auto command, reader_.next());
                if (!command) { break; }
                carry_out(*command);
            }
            catch_up();
            GYROLOG_CHECK(meet_plans());
            if (unplugged_) { return {}; }
            reply();
            if (!send(port.socket())) { return {}; }
        }
        return {};
    }

    Options options_;
    NativeBoard board_;
    UsbHost host_;
    SessionLog log_;
    Planned unplug_;
    Planned reset_;
    Planned suspend_;
    usbip::CommandReader reader_;
    Bytes replies_;
    UsbSetup configuration_{0, 9, 1, 0, 0, 0, 0, 0};
    std::optional<std::uint64_t> first_start_ticks_;
    std::int64_t host_ns_ = 0;
    bool unplugged_ = false;
};

int native_on_vhci(int argc, char** argv) {
    CLI::App app{"A port's firmware on the kernel's virtual USB host controller (vhci_hcd), until Ctrl-C"};
    Options options;
    app.add_option("--serial", options.serial, "serial number: 32 hexadecimal digits")
        ->check([](const std::string& text) {
            return text.size() == 2 * GLP_UID_BYTES &&
                           text.find_first_not_of("0123456789ABCDEF") == std::string::npos
                       ? std::string()
                       : std::string("expected 32 digits 0 to 9, A to F");
        })
        ->capture_default_str();
    app.add_option("--report", options.report_path, "file for the board's own accounts, written at the end");
    app.add_option("--unplug-after", options.unplug_after_s,
                   "pull the cable S seconds after the stream's start");
    app.add_option("--replug-after", options.replug_after_s,
                   "and put it back S seconds later; the board has power meanwhile");
    app.add_option("--reset-after", options.reset_after_s,
                   "reset the bus S seconds after the stream's start");
    app.add_option("--suspend-after", options.suspend_after_s,
                   "let the bus idle S seconds after the stream's start");
    app.add_option("--resume-after", options.resume_after_s,
                   "and wake it up S seconds later; 1 unless given");
    CLI11_PARSE(app, argc, argv);
    struct sigaction action {};
    action.sa_handler = [](int signal) { stop_signal = signal; };
    for (const int signal : {SIGINT, SIGTERM}) { sigaction(signal, &action, nullptr); }
    Bridge bridge(options);
    const Status served = bridge.run();
    if (!served.ok()) { std::cerr << argv[0] << ": " << served.error().message << '\n'; }
    return served.ok() ? 0 : 1;
}

}  // namespace
}  // namespace gyrolog

int main(int argc, char** argv) {
    try {
        return gyrolog::native_on_vhci(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << argv[0] << ": " << error.what() << '\n';
        return 1;
    }
}
