#include "host/transport/raw_port.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <gyrolog_protocol/usb_identity.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "host/usb/sysfs.hpp"

namespace gyrolog {
namespace {

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
            return {ErrorCode::permission_denied,
                    doing +
                        "permission denied; `gyrolog doctor` says what gives it, or "
                        "join the group that owns the port"};
        case EBUSY:
            return {ErrorCode::busy, doing + "in use by another program"};
        default:
            return {ErrorCode::failed, doing + std::generic_category().message(error_number)};
    }
}

// The speeds that Linux has names for (asm-generic/termbits.h).
constexpr std::array<std::pair<unsigned, speed_t>, 25> speeds{
    {{150, B150},         {300, B300},         {600, B600},         {1200, B1200},
     {1800, B1800},       {2400, B2400},       {4800, B4800},       {9600, B9600},
     {19200, B19200},     {38400, B38400},     {57600, B57600},     {115200, B115200},
     {230400, B230400},   {460800, B460800},   {500000, B500000},   {576000, B576000},
     {921600, B921600},   {1000000, B1000000}, {1152000, B1152000}, {1500000, B1500000},
     {2000000, B2000000}, {2500000, B2500000}, {3000000, B3000000}, {3500000, B3500000},
     {4000000, B4000000}}};

Result<speed_t> speed_named(const std::string& path, unsigned baud) {
    const auto* const found = std::ranges::find(speeds, baud, &std::pair<unsigned, speed_t>::first);
    if (found != speeds.end()) { return found->second; }
    return Error{ErrorCode::invalid_argument, "open serial port '" + path + "': no port has " +
                                                  std::to_string(baud) +
                                                  " baud; usual are 115200, 230400, 460800, 921600, 1000000, "
                                                  "2000000, 3000000 and 4000000"};
}

enum class SlotState : int { empty, being_filled, filled };

// What a signal handler must put back.
struct Slot {
    std::atomic<SlotState> state{SlotState::empty};
    int descriptor = -1;
    termios found{};
};

static_assert(std::atomic<SlotState>::is_always_lock_free, "a signal handler reads it");

std::array<Slot, 16> slots;

// Its place, if there is one.
std::optional<std::size_t> take_slot(int descriptor, const termios& found) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
        Slot& slot = slots[i];
        SlotState state = SlotState::empty;
        if (!slot.state.compare_exchange_strong(state, SlotState::being_filled)) { continue; }
        slot.descriptor = descriptor;
        slot.found = found;
        slot.state.store(SlotState::filled);
        return i;
    }
    return std::nullopt;
}

}  // namespace

struct RawPort::State {
    int descriptor;
    std::optional<termios> found;
    std::optional<std::size_t> slot;

    explicit State(int opened) : descriptor(opened) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    // A port that hung up has no settings any more. Closing lowers DTR (HUPCL).
    ~State() {
        static_cast<void>(ioctl(descriptor, TIOCNXCL));
        if (found) { static_cast<void>(tcsetattr(descriptor, TCSANOW, &*found)); }
        if (slot) { slots[*slot].state.store(SlotState::empty); }
        ::close(descriptor);
    }

    Status make_raw(const std::string& path, TtySpeed speed);
};

// Every byte as it comes, at once, and no modem lines but DTR.
Status RawPort::State::make_raw(const std::string& path, TtySpeed speed) {
    termios settings{};
    if (tcgetattr(descriptor, &settings) != 0) {
        return Error{ErrorCode::invalid_argument, "open serial port '" + path + "': not a terminal"};
    }
    found = settings;
    slot = take_slot(descriptor, settings);
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS);
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
    if (speed) {
        GYROLOG_TRY(const speed_t wanted, speed_named(path, *speed));
        cfsetispeed(&settings, wanted);
        cfsetospeed(&settings, wanted);
    }
    if (tcsetattr(descriptor, TCSANOW, &settings) != 0) { return open_error(path, errno); }
    // A driver that has not the speed takes the nearest, and says so only when it is asked.
    termios taken{};
    if (speed && (tcgetattr(descriptor, &taken) != 0 || cfgetospeed(&taken) != cfgetospeed(&settings))) {
        return Error{ErrorCode::invalid_argument,
                     "open serial port '" + path + "': it has not " + std::to_string(*speed) + " baud"};
    }
    return {};
}

RawPort::RawPort(std::unique_ptr<State> state) : state_(std::move(state)) {}
RawPort::RawPort(RawPort&&) noexcept = default;
RawPort::~RawPort() = default;

Result<RawPort> RawPort::open(const std::string& path, TtySpeed speed) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) { return open_error(path, errno); }
    auto state = std::make_unique<State>(descriptor);
    GYROLOG_CHECK(state->make_raw(path, speed));
    // A second reader would take away bytes. Where the request is unknown nothing is lost but this
    // protection.
    static_cast<void>(ioctl(descriptor, TIOCEXCL));
    return RawPort(std::move(state));
}

int RawPort::descriptor() const { return state_->descriptor; }

void restore_ports() noexcept {
    const int interrupted_errno = errno;
    for (const Slot& slot : slots) {
        if (slot.state.load() == SlotState::filled) {
            static_cast<void>(tcsetattr(slot.descriptor, TCSANOW, &slot.found));
        }
    }
    errno = interrupted_errno;
}

}  // namespace gyrolog
