// A CDC-ACM device for the real libusb: umockdev redirects this process's system calls on /sys and
// /dev/bus/usb, and this class answers usbfs's requests in the kernel's place. No root, no module. The
// process must run under umockdev-wrapper.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host/base/bytes.hpp"

namespace gyrolog::test {

// The device's side of the wire. Called on umockdev's thread, one call at a time.
class MockUsbFunction {
public:
    struct In {
        int status = 0;  // negative errno of the kernel; data may come with an error
        Bytes data;      // at most what was requested
    };

    virtual ~MockUsbFunction() = default;
    // 0, or -EPIPE to refuse.
    virtual int on_control(const std::array<std::uint8_t, 8>& setup, ByteView data) = 0;
    virtual void on_bulk_out(ByteView data) = 0;
    // The end of the oldest bulk IN request; nothing while the device has nothing to say.
    virtual std::optional<In> on_bulk_in(std::size_t requested_bytes) = 0;
};

struct MockUsbIdentity {
    std::uint16_t vendor_id = 0x1209;
    std::uint16_t product_id = 0x6779;
    std::uint8_t device_address = 2;  // on bus 1; also its port
    std::string manufacturer = "NXP";
    std::string product = "gyrolog MPU-9250";
    std::string serial = "S1";
    Bytes configuration_descriptor;  // empty: a CDC-ACM board's

    std::string sysfs_path() const;
    std::string device_node() const;
    // In umockdev's own format, for a testbed or for `umockdev-run --device`.
    std::string description() const;
};

Bytes cdc_acm_configuration(std::uint8_t endpoint_in, std::uint8_t endpoint_out,
                            std::uint8_t endpoint_notify = 0x82);

// The mocked machine. At most one at a time, since umockdev redirects the process as a whole.
class UmockdevBus {
public:
    UmockdevBus();
    UmockdevBus(const UmockdevBus&) = delete;
    UmockdevBus& operator=(const UmockdevBus&) = delete;
    ~UmockdevBus();

    // False when the process does not run under umockdev-wrapper: its calls then go to the real system.
    bool in_force() const;

    // A device that is there but never opened.
    void add_bystander(const MockUsbIdentity& identity);
    // The serial port of such a device, as the kernel's cdc_acm makes one: /sys/class/tty/PORT.
    void add_serial_port(const MockUsbIdentity& identity, const std::string& port);
    // Where the mocked /sys and /dev really are.
    std::string root_directory() const;

private:
    friend class UmockdevBoard;
    struct Testbed;
    std::unique_ptr<Testbed> testbed_;
};

class UmockdevBoard {
public:
    UmockdevBoard(UmockdevBus& bus, MockUsbIdentity identity, MockUsbFunction& function);
    UmockdevBoard(const UmockdevBoard&) = delete;
    UmockdevBoard& operator=(const UmockdevBoard&) = delete;
    ~UmockdevBoard();

    // The cable is pulled: pending requests end with -ESHUTDOWN, new ones are refused, sysfs forgets the
    // device.
    void unplug();
    // Another program holds the interfaces through usbfs.
    void claim_elsewhere();
    // Its device node may be opened by root alone.
    void forbid();
    // As on a kernel that cannot tell which driver is bound (umockdev's own replay is one).
    void hide_driver();
    // As a program leaves it that was killed: no driver, and nobody else either.
    void lose_driver();

    bool kernel_driver_bound() const;
    bool interface_claimed(std::uint8_t interface) const;
    std::uint64_t cleared_halts() const;
    std::uint64_t ioctls() const;

private:
    struct Usbfs;
    std::unique_ptr<Usbfs> usbfs_;
};

}  // namespace gyrolog::test
