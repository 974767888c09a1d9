#include "tests/support/umockdev_board.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

namespace gyrolog::test {
namespace {

std::string hex(ByteView bytes) {
    std::string text;
    std::array<char, 3> digits{};
    for (const std::uint8_t byte : bytes) {
        static_cast<void>(std::snprintf(digits.data(), digits.size(), "%02X", unsigned{byte}));
        text += digits.data();
    }
    return text;
}

std::string hex4(std::uint16_t value) {
    std::array<char, 5> digits{};
    static_cast<void>(std::snprintf(digits.data(), digits.size(), "%04x", unsigned{value}));
    return digits.data();
}

Bytes device_descriptor(const MockUsbIdentity& identity) {
    const auto low = [](std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xFFU); };
    const auto high = [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8U); };
    return {18,
            1,
            0,
            2,
            2,
            0,
            0,
            64,
            low(identity.vendor_id),
            high(identity.vendor_id),
            low(identity.product_id),
            high(identity.product_id),
            0,
            1,
            1,
            2,
            3,
            1};
}

struct Unref {
    void operator()(gpointer object) const { g_object_unref(object); }
};
template <typename T>
using GPointer = std::unique_ptr<T, Unref>;
using IoctlData = GPointer<UMockdevIoctlData>;

void fail(const char* what, const GError* error) {
    static_cast<void>(
        std::fprintf(stderr, "umockdev: %s: %s\n", what, error != nullptr ? error->message : "unknown"));
    std::abort();
}

template <typename T>
T& payload(const IoctlData& data) {
    return *reinterpret_cast<T*>(data->data);
}

// A request that the host has handed to the kernel.
struct Urb {
    IoctlData request;
    IoctlData buffer;

    usbdevfs_urb& fields() const { return payload<usbdevfs_urb>(request); }
    ByteView bytes() const { return {buffer->data, static_cast<std::size_t>(fields().buffer_length)}; }
};

constexpr std::uint8_t in_direction = 0x80;

}  // namespace

std::string MockUsbIdentity::sysfs_path() const {
    return "/devices/pci0000:00/0000:00:14.0/usb1/1-" + std::to_string(device_address);
}

std::string MockUsbIdentity::device_node() const {
    std::array<char, 32> path{};
    static_cast<void>(
        std::snprintf(path.data(), path.size(), "/dev/bus/usb/001/%03u", unsigned{device_address}));
    return path.data();
}

std::string MockUsbIdentity::description() const {
    const Bytes configuration =
        configuration_descriptor.empty() ? cdc_acm_configuration(0x81, 0x01) : configuration_descriptor;
    Bytes descriptors = device_descriptor(*this);
    descriptors.insert(descriptors.end(), configuration.begin(), configuration.end());
    const std::string address = std::to_string(device_address);
    std::string text = "P: " + sysfs_path() + "\n";
    text += "N: " + device_node().substr(5) + "\n";
    text +=
        "E: DEVNAME=" + device_node() + "\nE: DEVTYPE=usb_device\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=";
    text +=
        device_node().substr(17) + "\nE: MAJOR=189\nE: MINOR=" + std::to_string(device_address - 1) + "\n";
    text +=
        "E: SUBSYSTEM=usb\nA: authorized=1\nA: bConfigurationValue=1\nA: bDeviceClass=02\nA: "
        "bMaxPacketSize0=64\n";
    text += "A: bNumConfigurations=1\nA: busnum=1\nA: devnum=" + address + "\nA: devpath=" + address + "\n";
    text += "A: dev=189:" + std::to_string(device_address - 1) + "\n";
    text += "A: idVendor=" + hex4(vendor_id) + "\nA: idProduct=" + hex4(product_id) + "\n";
    text += "A: manufacturer=" + manufacturer + "\nA: product=" + product + "\n";
    if (!serial.empty()) { text += "A: serial=" + serial + "\n"; }
    text += "A: speed=12\nH: descriptors=" + hex(descriptors) + "\n";
    return text;
}

Bytes cdc_acm_configuration(std::uint8_t endpoint_in, std::uint8_t endpoint_out,
                            std::uint8_t endpoint_notify) {
    return {9,    2,    67,
            0,    2,    1,
            0,    0x80, 50,  // configuration 1
            9,    4,    0,
            0,    1,    2,
            2,    1,    0,  // interface 0: communications
            5,    0x24, 0,
            0x10, 1,  // header
            5,    0x24, 1,
            0,    1,  // call management
            4,    0x24, 2,
            2,  // abstract control management: line state
            5,    0x24, 6,
            0,    1,  // union
            7,    5,    endpoint_notify,
            3,    10,   0,
            9,  // notifications
            9,    4,    1,
            0,    2,    10,
            0,    0,    0,  // interface 1: data
            7,    5,    endpoint_in,
            2,    64,   0,
            0,  //
            7,    5,    endpoint_out,
            2,    64,   0,
            0};
}

struct UmockdevBus::Testbed {
    GPointer<UMockdevTestbed> handle{umockdev_testbed_new()};
};

UmockdevBus::UmockdevBus() : testbed_(std::make_unique<Testbed>()) {}
UmockdevBus::~UmockdevBus() = default;

bool UmockdevBus::in_force() const { return umockdev_in_mock_environment() != FALSE; }

void UmockdevBus::add_bystander(const MockUsbIdentity& identity) {
    GError* error = nullptr;
    umockdev_testbed_add_from_string(testbed_->handle.get(), identity.description().c_str(), &error);
    if (error != nullptr) { fail("add a device", error); }
}

void UmockdevBus::add_serial_port(const MockUsbIdentity& identity, const std::string& port) {
    const std::string address = std::to_string(identity.device_address);
    const std::string interface = identity.sysfs_path() + "/1-" + address + ":1.0";
    const std::string text = "P: " + interface + "/tty/" + port +
                             "\nE: SUBSYSTEM=tty\nL: device=../../../1-" + address +
                             ":1.0\n\nP: " + interface + "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\n\n" +
                             identity.description();
    GError* error = nullptr;
    umockdev_testbed_add_from_string(testbed_->handle.get(), text.c_str(), &error);
    if (error != nullptr) { fail("add a serial port", error); }
}

std::string UmockdevBus::root_directory() const {
    gchar* path = umockdev_testbed_get_root_dir(testbed_->handle.get());
    std::string copy(path);
    g_free(path);
    return copy;
}

// usbfs as linux/drivers/usb/core/devio.c behaves, as far as libusb uses it.
struct UmockdevBoard::Usbfs {
    Usbfs(UMockdevTestbed* bed, MockUsbIdentity who, MockUsbFunction& what)
        : testbed(bed), identity(std::move(who)), function(what), base(umockdev_ioctl_base_new()) {}

    static gboolean on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
        static_cast<Usbfs*>(self)->answer(client);
        return TRUE;
    }

    void answer(UMockdevIoctlClient* client);
    int perform(UMockdevIoctlClient* client, UMockdevIoctlData* argument, unsigned long request);
    int get_driver(UMockdevIoctlData* argument);
    int driver_ioctl(UMockdevIoctlData* argument);
    int claim(UMockdevIoctlClient* client, unsigned interface);
    int release(UMockdevIoctlClient* client, unsigned interface);
    int submit(UMockdevIoctlData* argument);
    int discard(UMockdevIoctlData* argument);
    int reap(UMockdevIoctlData* argument);
    std::optional<Urb> take_reapable();

    static IoctlData resolve(UMockdevIoctlData* data, std::size_t offset, std::size_t size) {
        GError* error = nullptr;
        IoctlData resolved(umockdev_ioctl_data_resolve(data, offset, size, &error));
        if (error != nullptr) { fail("read the caller's memory", error); }
        return resolved;
    }

    UMockdevTestbed* testbed;
    const MockUsbIdentity identity;
    MockUsbFunction& function;
    GPointer<UMockdevIoctlBase> base;

    mutable std::mutex mutex;
    std::deque<Urb> waiting;  // bulk and interrupt IN, oldest first
    std::deque<Urb> done;
    std::map<unsigned, UMockdevIoctlClient*> claimed;  // by which open file
    bool gone = false;
    bool held_elsewhere = false;
    bool driver_bound = true;
    bool driver_hidden = false;
    std::uint64_t cleared_halts = 0;
    std::uint64_t ioctls = 0;
};

// The kernel's convention inside: 0 or a negative errno.
void UmockdevBoard::Usbfs::answer(UMockdevIoctlClient* client) {
    const std::lock_guard lock(mutex);
    ++ioctls;
    const int code =
        perform(client, umockdev_ioctl_client_get_arg(client), umockdev_ioctl_client_get_request(client));
    umockdev_ioctl_client_complete(client, code < 0 ? -1 : 0, code < 0 ? -code : 0);
}

int UmockdevBoard::Usbfs::perform(UMockdevIoctlClient* client, UMockdevIoctlData* argument,
                                  unsigned long request) {
    switch (request) {
        case USBDEVFS_GET_CAPABILITIES:
            payload<std::uint32_t>(resolve(argument, 0, 4)) =
                USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
            return 0;
        case USBDEVFS_REAPURB:
        case USBDEVFS_REAPURBNDELAY:
            return reap(argument);
        case USBDEVFS_DISCARDURB:
            return discard(argument);
        default:
            break;
    }
    if (gone) { return -ENODEV; }
    switch (request) {
        case USBDEVFS_GETDRIVER:
            return get_driver(argument);
        case USBDEVFS_IOCTL:
            return driver_ioctl(argument);
        case USBDEVFS_CLAIMINTERFACE:
            return claim(client, payload<unsigned>(resolve(argument, 0, sizeof(unsigned))));
        case USBDEVFS_RELEASEINTERFACE:
            return release(client, payload<unsigned>(resolve(argument, 0, sizeof(unsigned))));
        case USBDEVFS_DISCONNECT_CLAIM:
            driver_bound = false;
            return claim(client, payload<usbdevfs_disconnect_claim>(
                                     resolve(argument, 0, sizeof(usbdevfs_disconnect_claim)))
                                     .interface);
        case USBDEVFS_CLEAR_HALT:
        case USBDEVFS_RESETEP:
            ++cleared_halts;
            return 0;
        case USBDEVFS_SETCONFIGURATION:
        case USBDEVFS_SETINTERFACE:
        case USBDEVFS_RESET:
            return 0;
        case USBDEVFS_SUBMITURB:
            return submit(argument);
        default:
            return -ENOTTY;
    }
}

int UmockdevBoard::Usbfs::get_driver(UMockdevIoctlData* argument) {
    if (driver_hidden) { return -ENOTTY; }
    const IoctlData data = resolve(argument, 0, sizeof(usbdevfs_getdriver));
    auto& query = payload<usbdevfs_getdriver>(data);
    const bool used_by_usbfs = held_elsewhere || claimed.count(query.interface) != 0;
    if (!used_by_usbfs && !driver_bound) { return -ENODATA; }
    static_cast<void>(
        std::snprintf(query.driver, sizeof query.driver, "%s", used_by_usbfs ? "usbfs" : "cdc_acm"));
    return 0;
}

int UmockdevBoard::Usbfs::driver_ioctl(UMockdevIoctlData* argument) {
    const auto command = payload<usbdevfs_ioctl>(resolve(argument, 0, sizeof(usbdevfs_ioctl)));
    // cdc_acm holds both interfaces and lets go of both.
    switch (static_cast<unsigned>(command.ioctl_code)) {
        case USBDEVFS_DISCONNECT:
            return std::exchange(driver_bound, false) ? 0 : -ENODATA;
        case USBDEVFS_CONNECT:
            if (!claimed.empty()) { return -EBUSY; }
            driver_bound = true;
            return 0;
        default:
            return -ENOTTY;
    }
}

int UmockdevBoard::Usbfs::claim(UMockdevIoctlClient* client, unsigned interface) {
    if (held_elsewhere || driver_bound) { return -EBUSY; }
    return claimed.emplace(interface, client).first->second == client ? 0 : -EBUSY;
}

int UmockdevBoard::Usbfs::release(UMockdevIoctlClient* client, unsigned interface) {
    const auto found = claimed.find(interface);
    if (found == claimed.end() || found->second != client) { return -EINVAL; }
    claimed.erase(found);
    return 0;
}

int UmockdevBoard::Usbfs::submit(UMockdevIoctlData* argument) {
    Urb urb;
    urb.request = resolve(argument, 0, sizeof(usbdevfs_urb));
    usbdevfs_urb& fields = urb.fields();
    urb.buffer = resolve(urb.request.get(), offsetof(usbdevfs_urb, buffer),
                         static_cast<std::size_t>(fields.buffer_length));
    if (fields.type == USBDEVFS_URB_TYPE_CONTROL) {
        std::array<std::uint8_t, 8> setup{};
        std::copy_n(urb.bytes().begin(), setup.size(), setup.begin());
        fields.status = function.on_control(setup, urb.bytes().subspan(setup.size()));
        fields.actual_length = fields.status == 0 ? fields.buffer_length - static_cast<int>(setup.size()) : 0;
        done.push_back(std::move(urb));
    } else if (claimed.count(fields.type == USBDEVFS_URB_TYPE_INTERRUPT ? 0U : 1U) == 0) {
        return -EINVAL;  // nobody may use an interface that is not claimed
    } else if ((fields.endpoint & in_direction) == 0) {
        function.on_bulk_out(urb.bytes());
        fields.status = 0;
        fields.actual_length = fields.buffer_length;
        done.push_back(std::move(urb));
    } else {
        waiting.push_back(std::move(urb));
    }
    return 0;
}

int UmockdevBoard::Usbfs::discard(UMockdevIoctlData* argument) {
    const gulong address = *reinterpret_cast<gulong*>(argument->data);
    const auto found = std::find_if(waiting.begin(), waiting.end(),
                                    [&](const Urb& urb) { return urb.request->client_addr == address; });
    if (found == waiting.end()) { return -EINVAL; }
    found->fields().status = -ENOENT;
    found->fields().actual_length = 0;
    done.push_back(std::move(*found));
    waiting.erase(found);
    return 0;
}

int UmockdevBoard::Usbfs::reap(UMockdevIoctlData* argument) {
    const std::optional<Urb> urb = take_reapable();
    if (!urb) {
        // umockdev's file is always ready, so libusb asks without a pause; a busy kernel would not answer at
        // all.
        if (!gone) { g_usleep(100); }
        return gone ? -ENODEV : -EAGAIN;
    }
    const IoctlData pointer = resolve(argument, 0, sizeof(void*));
    umockdev_ioctl_data_set_ptr(pointer.get(), 0, urb->request.get());
    return 0;
}

std::optional<Urb> UmockdevBoard::Usbfs::take_reapable() {
    if (done.empty() && !waiting.empty()) {
        usbdevfs_urb& fields = waiting.front().fields();
        std::optional<MockUsbFunction::In> end;
        if (gone) {
            end = MockUsbFunction::In{-ESHUTDOWN, {}};
        } else {
            end = function.on_bulk_in(static_cast<std::size_t>(fields.buffer_length));
        }
        if (end) {
            std::copy(end->data.begin(), end->data.end(), waiting.front().buffer->data);
            fields.status = end->status;
            fields.actual_length = static_cast<int>(end->data.size());
            done.push_back(std::move(waiting.front()));
            waiting.pop_front();
        }
    }
    if (done.empty()) { return std::nullopt; }
    Urb urb = std::move(done.front());
    done.pop_front();
    return urb;
}

UmockdevBoard::UmockdevBoard(UmockdevBus& bus, MockUsbIdentity identity, MockUsbFunction& function)
    : usbfs_(std::make_unique<Usbfs>(bus.testbed_->handle.get(), std::move(identity), function)) {
    g_signal_connect_after(usbfs_->base.get(), "handle-ioctl", G_CALLBACK(&Usbfs::on_ioctl), usbfs_.get());
    GError* error = nullptr;
    umockdev_testbed_attach_ioctl(usbfs_->testbed, usbfs_->identity.device_node().c_str(), usbfs_->base.get(),
                                  &error);
    if (error != nullptr) { fail("take over the device's requests", error); }
    umockdev_testbed_add_from_string(usbfs_->testbed, usbfs_->identity.description().c_str(), &error);
    if (error != nullptr) { fail("add the board", error); }
    // For a program that has looked at the bus before.
    umockdev_testbed_uevent(usbfs_->testbed, ("/sys" + usbfs_->identity.sysfs_path()).c_str(), "add");
}

UmockdevBoard::~UmockdevBoard() {
    unplug();
    umockdev_testbed_detach_ioctl(usbfs_->testbed, usbfs_->identity.device_node().c_str(), nullptr);
}

void UmockdevBoard::unplug() {
    {
        const std::lock_guard lock(usbfs_->mutex);
        if (std::exchange(usbfs_->gone, true)) { return; }
    }
    umockdev_testbed_uevent(usbfs_->testbed, ("/sys" + usbfs_->identity.sysfs_path()).c_str(), "remove");
    umockdev_testbed_remove_device(usbfs_->testbed, ("/sys" + usbfs_->identity.sysfs_path()).c_str());
}

void UmockdevBoard::claim_elsewhere() {
    const std::lock_guard lock(usbfs_->mutex);
    usbfs_->held_elsewhere = true;
    usbfs_->driver_bound = false;
}

void UmockdevBoard::hide_driver() {
    const std::lock_guard lock(usbfs_->mutex);
    usbfs_->driver_hidden = true;
    usbfs_->driver_bound = false;
}

void UmockdevBoard::lose_driver() {
    const std::lock_guard lock(usbfs_->mutex);
    usbfs_->driver_bound = false;
}

void UmockdevBoard::forbid() {
    namespace fs = std::filesystem;
    gchar* path = umockdev_testbed_get_root_dir(usbfs_->testbed);
    const fs::path root(path);
    g_free(path);
    // Everything but the node itself must stay reachable, umockdev's own socket for it included.
    fs::permissions(root, fs::perms(0755));
    fs::permissions(root / ("ioctl" + usbfs_->identity.device_node()), fs::perms::all);
    fs::permissions(root / usbfs_->identity.device_node().substr(1), fs::perms::none);
}

bool UmockdevBoard::kernel_driver_bound() const {
    const std::lock_guard lock(usbfs_->mutex);
    return usbfs_->driver_bound;
}

bool UmockdevBoard::interface_claimed(std::uint8_t interface) const {
    const std::lock_guard lock(usbfs_->mutex);
    return usbfs_->claimed.count(interface) != 0;
}

std::uint64_t UmockdevBoard::cleared_halts() const {
    const std::lock_guard lock(usbfs_->mutex);
    return usbfs_->cleared_halts;
}

std::uint64_t UmockdevBoard::ioctls() const {
    const std::lock_guard lock(usbfs_->mutex);
    return usbfs_->ioctls;
}

}  // namespace gyrolog::test
