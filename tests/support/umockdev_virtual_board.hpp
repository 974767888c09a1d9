// The virtual board behind umockdev's mocked usbfs: the firmware's own code answers the real libusb.
#pragma once

#include <algorithm>
#include <cerrno>

#include "host/base/clock.hpp"
#include "host/virtual_board/usb_descriptors.hpp"
#include "host/virtual_board/usb_function.hpp"
#include "tests/support/umockdev_board.hpp"

namespace gyrolog::test {

class VirtualBoardOnMock : public MockUsbFunction {
public:
    explicit VirtualBoardOnMock(VirtualBoard& board) : function_(board) {
        // The kernel has configured the device before any program sees it.
        constexpr std::array<std::uint8_t, 8> set_configuration_1 = {0x00, 9, 1, 0, 0, 0, 0, 0};
        function_.control(set_configuration_1, {});
    }

    static MockUsbIdentity identity(const std::string& serial, const UsbEndpoints& endpoints = {}) {
        MockUsbIdentity identity;
        identity.manufacturer = virtual_board_manufacturer;
        identity.product = virtual_board_product;
        identity.serial = serial;
        identity.configuration_descriptor = gyrolog::configuration_descriptor(endpoints);
        return identity;
    }

    int on_control(const std::array<std::uint8_t, 8>& setup, ByteView data) override {
        advance();
        return function_.control(setup, data).stall ? -EPIPE : 0;
    }
    void on_bulk_out(ByteView data) override {
        advance();
        function_.bulk_out(data);
    }
    std::optional<In> on_bulk_in(std::size_t requested_bytes) override {
        advance();
        if (function_.unplugged()) { return In{-ESHUTDOWN, {}}; }
        In in{0, Bytes(requested_bytes)};
        const std::optional<std::size_t> received = function_.bulk_in(in.data);
        if (!received) { return std::nullopt; }
        in.data.resize(*received);
        return in;
    }

private:
    void advance() { function_.advance_to(clock_ns(CLOCK_MONOTONIC)); }

    UsbFunction function_;
};

}  // namespace gyrolog::test
