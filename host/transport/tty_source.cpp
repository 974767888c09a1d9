#include "host/transport/tty_source.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <utility>

#include <gyrolog_protocol/usb_identity.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "host/usb/sysfs.hpp"

namespace gyrolog {
namespace {

constexpr std::int64_t write_timeout_ns = 1'000'000'000;
constexpr std::size_t read_bytes = 4096;
constexpr double kernel_buffer_bytes =
    4096;  // N_TTY_BUF_SIZE; the driver's own buffers in front of it come on top
constexpr std::uint8_t request_type_class_interface_out = 0x21;

std::string words_of(int error_number) { return std::generic_category().message(error_number); }

// For a port on USB the identity of the device behind it; sysfs shows the port's interface, one level below.
SourceIdentity identity_of(const std::string& path, const TtySpeed& speed) {
    SourceIdentity identity;
    identity.uri = "tty:" + path + (speed ? ",speed=" + std::to_string(*speed) : "");
    std::error_code missing;
    const std::filesystem::path port = std::filesystem::canonical(path, missing);
    if (missing) { return identity; }
    const std::filesystem::path interface =
        std::filesystem::canonical("/sys/class/tty/" + port.filename().string() + "/device", missing);
    if (missing) { return identity; }
    const std::string device = interface.parent_path().string();
    identity.vendor_id = static_cast<std::uint16_t>(read_sysfs_number(device, "idVendor", 16));
    identity.product_id = static_cast<std::uint16_t>(read_sysfs_number(device, "idProduct", 16));
    identity.bus_number = static_cast<std::uint8_t>(read_sysfs_number(device, "busnum", 10));
    identity.device_address = static_cast<std::uint8_t>(read_sysfs_number(device, "devnum", 10));
    identity.manufacturer = read_sysfs_text(device, "manufacturer");
    identity.product = read_sysfs_text(device, "product");
    identity.serial = read_sysfs_text(device, "serial");
    // A bridge to a UART is no CDC-ACM device, and its endpoints are not the board's.
    if (auto descriptors = read_usb_descriptors(device); descriptors.ok()) {
        identity.device_descriptor = std::move(descriptors->device);
        identity.configuration_descriptor = std::move(descriptors->configuration);
    }
    return identity;
}

// Where the port of this serial number is now: under its old name, or another one. Empty when there is none.
std::string port_of(const std::string& serial, const std::string& old_path) {
    if (serial.empty() || identity_of(old_path, {}).serial == serial) { return old_path; }
    std::error_code none;
    for (const auto& port : std::filesystem::directory_iterator("/sys/class/tty", none)) {
        std::string path = "/dev/" + port.path().filename().string();
        if (identity_of(path, {}).serial == serial) { return path; }
    }
    return {};
}

}  // namespace

// A write whose caller waits for `done`. Everything else is the thread's.
struct TtySource::PendingWrite {
    ByteView all;
    ByteView rest;
    std::uint64_t id = 0;
    std::int64_t deadline_ns = 0;

    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    Status status;
};

Result<std::unique_ptr<TtySource>> TtySource::open(const std::string& path, TtySpeed speed) {
    GYROLOG_TRY(RawPort port, RawPort::open(path, speed));
    const int wake = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (wake < 0) { return Error{ErrorCode::failed, "open serial port '" + path + "': " + words_of(errno)}; }
    return std::unique_ptr<TtySource>(new TtySource(std::move(port), path, speed, wake));
}

Status TtySource::reconnect() {
    // A port that is held open keeps its name from the board that comes back.
    let_go();
    const std::string path = port_of(identity_.serial, path_);
    if (path.empty()) {
        return Error{ErrorCode::not_found,
                     "open '" + identity_.uri + "': no port has the board's serial number"};
    }
    GYROLOG_TRY(RawPort port, RawPort::open(path, speed_));
    port_.emplace(std::move(port));
    identify(path);
    return {};
}

TtySource::TtySource(RawPort port, const std::string& path, TtySpeed speed, int wake)
    : port_(std::move(port)),
      speed_(speed),
      wake_(wake),
      calls_([this] { this->wake(); }),
      buffer_(read_bytes) {
    identify(path);
}

void TtySource::identify(const std::string& path) {
    path_ = path;
    identity_ = identity_of(path, speed_);
    endpoints_ = {};
    if (const auto layout = parse_cdc_configuration(identity_.configuration_descriptor); layout.ok()) {
        endpoints_ = {layout->endpoint_in, layout->endpoint_out};
    }
}

void TtySource::let_go() {
    TtySource::stop();
    port_.reset();
}

TtySource::~TtySource() {
    TtySource::let_go();
    ::close(wake_);
}

double TtySource::tolerated_stall_s(double bytes_per_s, double /*bytes_per_frame*/) const {
    return kernel_buffer_bytes / bytes_per_s;
}

void TtySource::wake() const {
    // A full counter wakes as well.
    static_cast<void>(eventfd_write(wake_, 1));
}

Status TtySource::start(TransferSink& sink) {
    if (!port_) { return Error{ErrorCode::device_lost, identity_.uri + ": the port is closed"}; }
    sink_ = &sink;
    stop_asked_ = false;
    calls_.reopen();
    thread_ = std::thread([this] { run(); });
    pthread_setname_np(thread_.native_handle(), "gyrolog-tty");
    // Opening the port has raised DTR. A port without it begins to stream on a command.
    const Status quieted = set_line_state(false);
    if (!quieted.ok() && quieted.error().code == ErrorCode::failed) {
        stop();
        return quieted.error();
    }
    silence_.await([](std::int64_t time_ns) {
        std::this_thread::sleep_for(std::chrono::nanoseconds(time_ns));
        return false;
    });
    return {};
}

void TtySource::stop() {
    if (!thread_.joinable()) { return; }
    stop_asked_ = true;
    wake();
    thread_.join();
}

Status TtySource::set_line_state(bool data_terminal_ready) {
    Status status = Error{ErrorCode::device_lost, "set DTR of '" + identity_.uri + "': the port is closed"};
    static_cast<void>(calls_.call([&] { status = change_line_state(data_terminal_ready); }));
    return status;
}

Status TtySource::write(ByteView bytes) {
    PendingWrite write{};
    write.all = write.rest = bytes;
    write.deadline_ns = clock_ns(CLOCK_MONOTONIC) + write_timeout_ns;
    bool accepted = false;
    const bool running = calls_.call([&] {
        if (pending_write_ != nullptr) { return; }
        pending_write_ = &write;
        accepted = true;
        Transfer told;
        told.event = Transfer::Event::submission;
        told.endpoint = endpoints_.out;
        told.id = write.id = ++last_id_;
        told.requested_bytes = static_cast<std::uint32_t>(bytes.size());
        told.time = host_now();
        told.data = bytes;
        static_cast<void>(sink_->on_transfer(told));
    });
    if (!running) {
        return Error{ErrorCode::device_lost, "write to '" + identity_.uri + "': the port is closed"};
    }
    if (!accepted) {
        return Error{ErrorCode::busy, "write to '" + identity_.uri + "': another write is under way"};
    }
    std::unique_lock lock(write.mutex);
    write.changed.wait(lock, [&] { return write.done; });
    return write.status;
}

void TtySource::run() {
    calls_.adopt();
    lost_ = false;
    tell_read_submission();
    while (!stop_asked_ && !lost_) {
        calls_.run_pending();
        wait_for_events();
    }
    calls_.close();
    const Error closed{ErrorCode::device_lost, "write to '" + identity_.uri + "': the port was closed"};
    if (pending_write_ != nullptr) { finish_write(-ESHUTDOWN, closed); }
    tell_read_completion(lost_ ? -ESHUTDOWN : -ENOENT, {});
    if (lost_) {
        sink_->on_end(SourceEnd::device_lost, Error{ErrorCode::device_lost, lost_why_});
    } else {
        sink_->on_end(SourceEnd::stopped, std::nullopt);
    }
}

void TtySource::wait_for_events() {
    const bool writing = pending_write_ != nullptr;
    std::array<pollfd, 2> watched{{{wake_, POLLIN, 0}, {port_->descriptor(), POLLIN, 0}}};
    timespec left{};
    if (writing) {
        watched[1].events |= POLLOUT;
        const std::int64_t left_ns =
            std::max<std::int64_t>(0, pending_write_->deadline_ns - clock_ns(CLOCK_MONOTONIC));
        left = {left_ns / 1'000'000'000, left_ns % 1'000'000'000};
    }
    if (ppoll(watched.data(), watched.size(), writing ? &left : nullptr, nullptr) < 0) {
        if (errno != EINTR) { lose(errno); }
        return;
    }
    if (watched[0].revents != 0) {
        eventfd_t count = 0;
        static_cast<void>(eventfd_read(wake_, &count));
    }
    const short events = watched[1].revents;
    if ((events & (POLLIN | POLLHUP | POLLERR | POLLNVAL)) != 0) { read_available((events & POLLHUP) != 0); }
    if (pending_write_ != nullptr) { write_pending(); }
}

// One read a turn, so that a write never waits behind a stream that does not pause.
void TtySource::read_available(bool hung_up) {
    const ssize_t count = ::read(port_->descriptor(), buffer_.data(), buffer_.size());
    if (count > 0) {
        silence_.heard();
        tell_read_completion(0, ByteView(buffer_).first(static_cast<std::size_t>(count)));
        tell_read_submission();
        return;
    }
    const bool nothing_yet = count < 0 && (errno == EAGAIN || errno == EINTR);
    if (!nothing_yet || hung_up) { lose(count == 0 || nothing_yet ? EIO : errno); }
}

void TtySource::write_pending() {
    PendingWrite& write = *pending_write_;
    const ssize_t count = ::write(port_->descriptor(), write.rest.data(), write.rest.size());
    if (count >= 0) { write.rest = write.rest.subspan(static_cast<std::size_t>(count)); }
    if (write.rest.empty()) {
        finish_write(0, {});
    } else if (count < 0 && errno != EAGAIN && errno != EINTR) {
        finish_write(-EPROTO,
                     Error{ErrorCode::failed, "write to '" + identity_.uri + "': " + words_of(errno)});
    } else if (clock_ns(CLOCK_MONOTONIC) >= write.deadline_ns) {
        finish_write(-ENOENT,
                     Error{ErrorCode::timeout, "write to '" + identity_.uri + "': not taken in time"});
    }
}

void TtySource::finish_write(int kernel_status, Status status) {
    PendingWrite& write = *std::exchange(pending_write_, nullptr);
    Transfer told;
    told.endpoint = endpoints_.out;
    told.id = write.id;
    told.status = kernel_status;
    told.requested_bytes = static_cast<std::uint32_t>(write.all.size());
    told.time = host_now();
    static_cast<void>(sink_->on_transfer(told));
    const std::lock_guard lock(write.mutex);
    write.status = std::move(status);
    write.done = true;
    write.changed.notify_all();
}

void TtySource::tell_read_submission() {
    Transfer told;
    told.event = Transfer::Event::submission;
    told.endpoint = endpoints_.in;
    told.id = read_id_ = ++last_id_;
    told.requested_bytes = static_cast<std::uint32_t>(buffer_.size());
    told.time = host_now();
    static_cast<void>(sink_->on_transfer(told));
}

void TtySource::tell_read_completion(int status, ByteView data) {
    Transfer told;
    told.endpoint = endpoints_.in;
    told.id = read_id_;
    told.status = status;
    told.requested_bytes = static_cast<std::uint32_t>(buffer_.size());
    told.time = host_now();
    told.data = data;
    // A full sink has counted what it refused; the kernel's buffer does not wait.
    static_cast<void>(sink_->on_transfer(told));
}

Status TtySource::change_line_state(bool data_terminal_ready) {
    int lines = TIOCM_DTR;
    const HostTime submitted = host_now();
    if (ioctl(port_->descriptor(), data_terminal_ready ? TIOCMBIS : TIOCMBIC, &lines) != 0) {
        const bool has_none = errno == ENOTTY || errno == EINVAL;
        return Error{has_none ? ErrorCode::unsupported : ErrorCode::failed,
                     "set DTR of '" + identity_.uri + "': " + words_of(errno)};
    }
    Transfer told;
    told.event = Transfer::Event::submission;
    told.kind = TransferKind::control;
    told.id = ++last_id_;
    told.setup = {request_type_class_interface_out, GLP_CDC_SET_CONTROL_LINE_STATE,
                  static_cast<std::uint8_t>(data_terminal_ready ? GLP_CDC_LINE_DTR : 0)};
    told.time = submitted;
    static_cast<void>(sink_->on_transfer(told));
    told.event = Transfer::Event::completion;
    told.time = host_now();
    static_cast<void>(sink_->on_transfer(told));
    return {};
}

void TtySource::lose(int error_number) {
    lost_ = true;
    lost_why_ = "read from '" + identity_.uri + "': the port hung up (" + words_of(error_number) + ")";
}

}  // namespace gyrolog
