// A day at 1 kHz through the whole USB path, faster than real time: the program with the real libusb, on a
// mocked usbfs, behind which the firmware's own code runs as fast as its data are taken. The default is a
// part of it.

#include <cerrno>

#include "host/virtual_board/usb_function.hpp"
#include "tests/end_to_end/soak.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/umockdev_virtual_board.hpp"

namespace gyrolog {
namespace {

using test::MockUsbFunction;

// Board time goes on while the host wants data, and only then. Packets are filled across frames, as
// SPEC.md 10.4 recommends: the many short transfers of a board in real time would take umockdev hours.
class HurriedBoard final : public MockUsbFunction {
public:
    explicit HurriedBoard(VirtualBoard& board) : function_(board) {
        constexpr std::array<std::uint8_t, 8> set_configuration_1 = {0x00, 9, 1, 0, 0, 0, 0, 0};
        function_.control(set_configuration_1, {});
    }

    int on_control(const std::array<std::uint8_t, 8>& setup, ByteView data) override {
        run();
        return function_.control(setup, data).stall ? -EPIPE : 0;
    }
    void on_bulk_out(ByteView data) override {
        run();
        function_.bulk_out(data);
    }
    std::optional<In> on_bulk_in(std::size_t requested_bytes) override {
        // A board that streams fills the request in this time; one that does not has sent what it had.
        constexpr int turns_max = 400;
        for (int turn = 0; turn < turns_max && gathered_.size() < requested_bytes; ++turn) { run(); }
        if (gathered_.empty()) { return std::nullopt; }
        const auto size = static_cast<std::ptrdiff_t>(std::min(gathered_.size(), requested_bytes));
        In in{0, Bytes(gathered_.begin(), gathered_.begin() + size)};
        gathered_.erase(gathered_.begin(), gathered_.begin() + size);
        return in;
    }

private:
    void run() {
        constexpr std::int64_t turn_ns = 5'000'000;
        function_.advance_to(now_ns_ += turn_ns);
        while (const auto received = function_.bulk_in(packet_)) {
            gathered_.insert(gathered_.end(), packet_.begin(),
                             packet_.begin() + static_cast<std::ptrdiff_t>(*received));
            if (*received == 0) { break; }
        }
    }

    UsbFunction function_;
    std::int64_t now_ns_ = 0;
    std::array<std::uint8_t, 4096> packet_{};
    Bytes gathered_;
};

TEST(SoakUsb, DayAt1kHzLosesNothingInFlatMemory) {
    const double hours = soak_hours(0.4);
    test::UmockdevBus bus;
    if (!bus.in_force()) { GTEST_SKIP() << needs_umockdev_wrapper; }
    VirtualBoardOptions options;
    options.rate_hz = 1000.0;
    options.dlpf_hz = 184;
    auto board = VirtualBoard::create(std::move(options));
    ASSERT_TRUE(board.ok()) << board.error().message;
    HurriedBoard function(**board);
    const test::UmockdevBoard plugged(bus, test::VirtualBoardOnMock::identity("SOAK1"), function);
    const TemporaryFolder folder;
    const std::string capture = folder.path("soak.pcapng");
    const WatchedRun run = run_watched({gyrolog_path(), "capture", "--device", "usb:SOAK1", "--duration",
                                        std::to_string(hours) + "h", "-o", capture},
                                       folder.path("err"));
    expect_sound(run, capture, folder.path("err"), 1000, hours);
    EXPECT_TRUE(plugged.kernel_driver_bound()) << "given back";
}

}  // namespace
}  // namespace gyrolog
