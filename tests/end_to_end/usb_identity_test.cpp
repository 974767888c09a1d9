// Which devices on USB the program takes, and which it leaves alone: the program with the real libusb, on a
// mocked kernel.
#include <cerrno>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/needs.hpp"
#include "tests/support/program.hpp"
#include "tests/support/umockdev_virtual_board.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using test::MockUsbFunction;
using test::MockUsbIdentity;
using test::UmockdevBoard;
using test::VirtualBoardOnMock;
using testing::HasSubstr;
using testing::Not;

// Takes every request, and says the same few bytes or nothing.
class Mumbling final : public MockUsbFunction {
public:
    explicit Mumbling(Bytes word) : word_(std::move(word)) {}

    int on_control(const std::array<std::uint8_t, 8>& setup, ByteView /*data*/) override {
        raised_ = setup[1] == 0x22 && (setup[2] & 1U) != 0;
        said_ = false;
        return 0;
    }
    void on_bulk_out(ByteView /*data*/) override {}
    std::optional<In> on_bulk_in(std::size_t /*requested_bytes*/) override {
        if (!raised_ || said_ || word_.empty()) { return std::nullopt; }
        said_ = true;
        return In{0, word_};
    }

private:
    Bytes word_;
    bool raised_ = false;
    bool said_ = false;
};

class UsbIdentity : public testing::Test {
protected:
    void SetUp() override {
        if (!bus_.in_force()) { GTEST_SKIP() << needs_umockdev_wrapper; }
    }

    static MockUsbIdentity identity(std::uint16_t vendor_id, std::uint16_t product_id,
                                    const std::string& product, const UsbEndpoints& endpoints = {}) {
        MockUsbIdentity identity = VirtualBoardOnMock::identity("S1", endpoints);
        identity.vendor_id = vendor_id;
        identity.product_id = product_id;
        identity.product = product;
        return identity;
    }
    // A virtual board of this identity, plugged in.
    void plug_in_board(const MockUsbIdentity& identity) {
        VirtualBoardOptions options;
        options.serial = identity.serial;
        board_ = VirtualBoard::create(std::move(options)).value();
        function_ = std::make_unique<VirtualBoardOnMock>(*board_);
        device_ = std::make_unique<UmockdevBoard>(bus_, identity, *function_);
    }
    ProgramResult capture(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments = {"capture", "--samples", "20", "-o", path()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_gyrolog(arguments);
    }
    std::string path() const { return folder_.path("x.pcapng"); }

    test::UmockdevBus bus_;
    TemporaryFolder folder_;
    std::unique_ptr<VirtualBoard> board_;
    std::unique_ptr<MockUsbFunction> function_;
    std::unique_ptr<UmockdevBoard> device_;
};

TEST_F(UsbIdentity, ABoardIsCapturedAndNothingIsSaidOfItsId) {
    plug_in_board(identity(0x1209, 0x6779, "gyrolog on a bench", fixed_kind_endpoints));
    const ProgramResult captured = capture();
    EXPECT_EQ(captured.exit_code, 0) << captured.err;
    EXPECT_THAT(captured.err, Not(HasSubstr("warning")));
    EXPECT_TRUE(device_->kernel_driver_bound()) << "given back";
    const json info = json::parse(run_gyrolog({"info", path(), "--json", "-"}).out);
    EXPECT_EQ(info["board"]["vid"], "1209");
    EXPECT_EQ(info["board"]["pid"], "6779");
    const json listed = json::parse(run_gyrolog({"list", "--json", "-"}).out);
    ASSERT_EQ(listed["devices"].size(), 1U);
    EXPECT_EQ(listed["devices"][0]["state"], "ready");
    EXPECT_EQ(listed["devices"][0]["why"], "");
    EXPECT_EQ(run_gyrolog({"check", path()}).exit_code, 0);
}

TEST_F(UsbIdentity, TheFormerIdIsTakenWithAWarningThatNamesTheNewOne) {
    plug_in_board(identity(0x1FC9, 0x0083, "gyrolog MPU-9250"));
    for (const ProgramResult& result : {capture(), run_gyrolog({"list"})}) {
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_THAT(result.err, HasSubstr("warning: usb:S1 has the id 1fc9:0083"));
        EXPECT_THAT(result.err, HasSubstr("1209:6779"));
    }
    // Its capture is read like any other, and what is stored is no longer plugged in.
    for (const char* command : {"info", "check"}) {
        const ProgramResult read = run_gyrolog({command, path()});
        EXPECT_EQ(read.exit_code, 0) << read.err;
    }
    const ProgramResult replayed =
        run_gyrolog({"capture", "--device", "replay:" + path(), "-o", folder_.path("again.pcapng")});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_THAT(replayed.err, Not(HasSubstr("warning")));
}

TEST_F(UsbIdentity, AStrangersDeviceKeepsItsDriverAndListSaysWhy) {
    struct Stranger {
        MockUsbIdentity identity;
        const char* why;
    };
    const Stranger strangers[] = {
        {identity(0x1FC9, 0x0083, "LPC VCOM"), "not a board by its product name, 'LPC VCOM'"},
        {identity(0x1209, 0x6779, "lab supply"), "not a board by its product name, 'lab supply'"},
        {identity(0x0483, 0x5740, "gyrolog clone"), "not a board by its id"}};
    Mumbling function({});
    for (const Stranger& stranger : strangers) {
        SCOPED_TRACE(stranger.why);
        const UmockdevBoard device(bus_, stranger.identity, function);
        const ProgramResult listed = run_gyrolog({"list", "--json", "-"});
        EXPECT_EQ(listed.exit_code, 3);
        const json devices = json::parse(listed.out)["devices"];
        ASSERT_EQ(devices.size(), 1U);
        EXPECT_EQ(devices[0]["state"], "wrong_protocol");
        EXPECT_THAT(devices[0]["why"].get<std::string>(), HasSubstr(stranger.why));
        EXPECT_THAT(run_gyrolog({"list"}).out, HasSubstr(stranger.why));
        const std::vector<std::string> attempts[] = {{"-o", path()},
                                                     {"capture", "-o", path()},
                                                     {"capture", "--device", "usb:S1", "-o", path()},
                                                     {"capture", "--device", "usb:*", "-o", path()},
                                                     {"conform", "--device", "usb:"}};
        for (const std::vector<std::string>& attempt : attempts) {
            const ProgramResult refused = run_gyrolog(attempt);
            EXPECT_EQ(refused.exit_code, 3) << attempt.front() << ": " << refused.err;
        }
        EXPECT_TRUE(device.kernel_driver_bound());
        EXPECT_EQ(device.ioctls(), 0U) << "nothing was asked of it";
        EXPECT_FALSE(std::filesystem::exists(path()));
    }
}

// SPEC.md, 10.6.
TEST_F(UsbIdentity, ADeviceWithoutHelloIsGivenBackAndCalledNoBoard) {
    for (const Bytes& word : {Bytes{}, Bytes(100, 0x24)}) {
        SCOPED_TRACE(word.size());
        Mumbling function(word);
        const UmockdevBoard device(bus_, identity(0x1209, 0x6779, "gyrolog lookalike"), function);
        const ProgramResult refused = capture({"--force"});
        EXPECT_NE(refused.exit_code, 0);
        EXPECT_THAT(refused.err, HasSubstr("no gyrolog board"));
        EXPECT_THAT(refused.err, HasSubstr("let go"));
        EXPECT_TRUE(device.kernel_driver_bound());
        EXPECT_FALSE(device.interface_claimed(0));
        EXPECT_FALSE(device.interface_claimed(1));
    }
}

}  // namespace
}  // namespace gyrolog
