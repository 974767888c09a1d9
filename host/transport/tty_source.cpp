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

#include <fcntl.h>
#include <gyrolog_protocol/usb_identity.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <termios.h>
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

// A board whose port is gone because a program that had taken the board away from the kernel's driver was
// killed: its control interface is there and has no driver. Empty when there is none.
std::string hint_of_a_taken_port() {
    namespace fs = std::filesystem;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator("/sys/bus/usb/devices", none)) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with(":1.0") || fs::exists(entry.path() / "driver", none)) { continue; }
        const std::string device = "/sys/bus/usb/devices/" + name.substr(0, name.find(':'));
        const auto vendor_id = static_cast<std::uint16_t>(read_sysfs_number(device, "idVendor", 16));
        const auto product_id = static_cast<std::uint16_t>(read_sysfs_number(device, "idProduct", 16));
        if (glp_usb_id_of(vendor_id, product_id) != glp_usb_id_other &&
            read_sysfs_text(device, "product").starts_with(GLP_USB_PRODUCT_PREFIX)) {
            return "; a board is there whose port a killed program has taken along: plug it in again, or run "
                   "`echo " +
                   name + " | sudo tee /sys/bus/usb/drivers/cdc_acm/bind`";
        }
    }
    return {};
}

Error open_error(const std::string& path, int error_number) {
    const std::string doing = "open serial port '" + path + "': ";
    switch (error_number) {
        case ENOENT:
        case ENODEV:
        case ENXIO:
            return {ErrorCode::not_found, doing + "not there" + hint_of_a_taken_port()};
        case EACCES:
        case EPERM:
            return {ErrorCode::permission_denied, doing +
                                                      "permission denied; install tools/60-gyrolog.rules, or "
                                                      "join the group that owns the port"};
        case EBUSY:
            return {ErrorCode::busy, doing + "in use by another program"};
        default:
            return {ErrorCode::failed, doing + words_of(error_number)};
    }
}

// For a port on USB the identity of the device behind it; sysfs shows the port's interface, one level below.
SourceIdentity identity_of(const std::string& path) {
    SourceIdentity identity;
    identity.uri = "tty:" + path;
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

// Every byte as it comes, at once, and no modem lines but DTR. The speed means nothing to a board on USB; on
// a UART bridge the line's present one is kept.
Status make_raw(int terminal, const std::string& path) {
    termios settings{};
    if (tcgetattr(terminal, &settings) != 0) {
        return Error{ErrorCode::invalid_argument, "open serial port '" + path + "': not a terminal"};
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS);
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
    if (tcsetattr(terminal, TCSANOW, &settings) != 0) { return open_error(path, errno); }
    return {};
}

Result<int> open_terminal(const std::string& path) {
    const int terminal = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (terminal < 0) { return open_error(path, errno); }
    if (Status raw = make_raw(terminal, path); !raw.ok()) {
        ::close(terminal);
        return std::move(raw).error();
    }
    // A second reader would take away bytes. Where the request is unknown nothing is lost but this
    // protection.
    static_cast<void>(ioctl(terminal, TIOCEXCL));
    return terminal;
}

// Where the port of this identity is now: under its old name, or another one with the same serial number.
// Empty when there is none.
std::string port_of(const SourceIdentity& identity) {
    std::string old_path = identity.uri.substr(std::string("tty:").size());
    if (identity.serial.empty() || identity_of(old_path).serial == identity.serial) { return old_path; }
    std::error_code none;
    for (const auto& port : std::filesystem::directory_iterator("/sys/class/tty", none)) {
        std::string path = "/dev/" + port.path().filename().string();
        if (identity_of(path).serial == identity.serial) { return path; }
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

Result<std::unique_ptr<TtySource>> TtySource::open(const std::string& path) {
    GYROLOG_TRY(const int terminal, open_terminal(path));
    const int wake = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    // From here on the source closes both.
    std::unique_ptr<TtySource> source(new TtySource(terminal, wake, path));
    if (wake < 0) { return open_error(path, errno); }
    return source;
}

Status TtySource::reconnect() {
    // A port that is held open keeps its name from the board that comes back.
    let_go();
    const std::string path = port_of(identity_);
    if (path.empty()) {
        return Error{ErrorCode::not_found,
                     "open '" + identity_.uri + "': no port has the board's serial number"};
    }
    GYROLOG_TRY(terminal_, open_terminal(path));
    identify(path);
    return {};
}

TtySource::TtySource(int terminal, int wake, const std::string& path)
    : terminal_(terminal), wake_(wake), calls_([this] { this->wake(); }), buffer_(read_bytes) {
    identify(path);
}

void TtySource::identify(const std::string& path) {
    identity_ = identity_of(path);
    endpoints_ = {};
    if (const auto layout = parse_cdc_configuration(identity_.configuration_descriptor); layout.ok()) {
        endpoints_ = {layout->endpoint_in, layout->endpoint_out};
    }
}

void TtySource::let_go() {
    TtySource::stop();
    // Closing lowers DTR (HUPCL).
    if (terminal_ >= 0) { ::close(std::exchange(terminal_, -1)); }
}

TtySource::~TtySource() {
    TtySource::let_go();
    if (wake_ >= 0) { ::close(wake_); }
}

double TtySource::tolerated_stall_s(double bytes_per_s, double /*bytes_per_frame*/) const {
    return kernel_buffer_bytes / bytes_per_s;
}

void TtySource::wake() const {
    // A full counter wakes as well.
    static_cast<void>(eventfd_write(wake_, 1));
}

Status TtySource::start(TransferSink& sink) {
    if (terminal_ < 0) { return Error{ErrorCode::device_lost, identity_.uri + ": the port is closed"}; }
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
    std::array<pollfd, 2> watched{{{wake_, POLLIN, 0}, {terminal_, POLLIN, 0}}};
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
    const ssize_t count = ::read(terminal_, buffer_.data(), buffer_.size());
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
    const ssize_t count = ::write(terminal_, write.rest.data(), write.rest.size());
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
    if (ioctl(terminal_, data_terminal_ready ? TIOCMBIS : TIOCMBIC, &lines) != 0) {
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
