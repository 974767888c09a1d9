// The real libusb on a mocked kernel: everything from the survey of the bus to the last callback.
#include "host/transport/usb_source.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <gyrolog_protocol/usb_identity.h>
#include <unistd.h>

#include "host/base/clock.hpp"
#include "tests/support/collecting_sink.hpp"
#include "tests/support/needs.hpp"
#include "tests/support/umockdev_board.hpp"

namespace gyrolog {
namespace {

using test::CollectingSink;
using test::MockUsbFunction;
using test::MockUsbIdentity;
using test::UmockdevBoard;
using test::UmockdevBus;
using ::testing::HasSubstr;

constexpr BulkInPlan few_transfers{8, 512};

// Streams a running count while DTR is raised, in short packets of 40 bytes unless told otherwise.
class CountingFunction : public MockUsbFunction {
public:
    int on_control(const std::array<std::uint8_t, 8>& setup, ByteView /*data*/) override {
        if (setup[1] != GLP_CDC_SET_CONTROL_LINE_STATE) { return -EPIPE; }
        if (refuses_line_state) { return -EPIPE; }
        dtr = (setup[2] & GLP_CDC_LINE_DTR) != 0;
        lowered_ = std::chrono::steady_clock::now();
        return 0;
    }
    void on_bulk_out(ByteView data) override { received.insert(received.end(), data.begin(), data.end()); }
    std::optional<In> on_bulk_in(std::size_t requested_bytes) override {
        if (stale_bytes > 0) { return In{0, count(std::exchange(stale_bytes, 0))}; }
        if (!dtr && std::chrono::steady_clock::now() - lowered_ >= talks_on) { return std::nullopt; }
        if (script) { return script(*this, requested_bytes); }
        return In{0, count(40)};
    }

    Bytes count(std::size_t size_bytes) {
        Bytes bytes(size_bytes);
        for (std::uint8_t& byte : bytes) { byte = next_++; }
        return bytes;
    }

    std::atomic<bool> dtr{true};  // as another program may have left it
    bool refuses_line_state = false;
    std::size_t stale_bytes = 0;
    std::function<std::optional<In>(CountingFunction&, std::size_t)> script;
    std::chrono::milliseconds talks_on{0};  // after DTR was lowered
    Bytes received;

private:
    std::chrono::steady_clock::time_point lowered_;
    std::uint8_t next_ = 0;
};

void expect_running_count(const Bytes& stream) {
    for (std::size_t i = 0; i < stream.size(); ++i) { ASSERT_EQ(stream[i], i % 256) << "at byte " << i; }
}

std::int64_t last_data_before(std::int64_t end_ns, const CollectingSink& sink) {
    std::int64_t last_ns = 0;
    for (const CollectingSink::Told& told : sink.told()) {
        const std::int64_t time_ns = told.transfer.time.monotonic_ns;
        if (!told.data.empty() && time_ns < end_ns) { last_ns = time_ns; }
    }
    return last_ns;
}

class UsbSourceTest : public ::testing::Test {
protected:
    void SetUp() override {
        bus_ = std::make_unique<UmockdevBus>();
        if (!bus_->in_force()) { GTEST_SKIP() << needs_umockdev_wrapper; }
    }
    void TearDown() override {
        source_.reset();
        usb_.reset();
        boards_.clear();
    }

    UmockdevBoard& plug_in(const MockUsbIdentity& identity = {}) { return plug_in(identity, function_); }
    UmockdevBoard& plug_in(const MockUsbIdentity& identity, MockUsbFunction& function) {
        boards_.push_back(std::make_unique<UmockdevBoard>(*bus_, identity, function));
        return *boards_.back();
    }

    // After the boards are there: libusb looks at the bus when its context starts.
    void start_libusb() {
        auto usb = UsbContext::create();
        ASSERT_TRUE(usb.ok()) << usb.error().message;
        usb_ = std::move(usb).value();
    }
    Error refusal(std::string_view serial) {
        auto opened = UsbSource::open(usb_, serial, few_transfers);
        EXPECT_FALSE(opened.ok());
        return opened.ok() ? Error{ErrorCode::failed, "opened"} : opened.error();
    }
    void open(std::string_view serial = "") {
        start_libusb();
        auto source = UsbSource::open(usb_, serial, few_transfers);
        ASSERT_TRUE(source.ok()) << source.error().message;
        source_ = std::move(source).value();
    }
    void start() {
        const Status started = source_->start(sink_);
        ASSERT_TRUE(started.ok()) << started.error().message;
    }
    void raise_line() {
        const Status raised = source_->set_line_state(true);
        ASSERT_TRUE(raised.ok()) << raised.error().message;
    }

    CountingFunction function_;
    CountingFunction second_function_;
    std::unique_ptr<UmockdevBus> bus_;
    std::vector<std::unique_ptr<UmockdevBoard>> boards_;
    std::shared_ptr<UsbContext> usb_;
    CollectingSink sink_;
    std::unique_ptr<UsbSource> source_;
};

TEST_F(UsbSourceTest, ABoardStreamsFromTheFirstByteToTheLast) {
    plug_in();
    open();
    start();
    EXPECT_EQ(sink_.stream().size(), 0U);
    raise_line();
    EXPECT_TRUE(sink_.wait_for_bytes(20'000));
    source_->stop();
    EXPECT_EQ(sink_.end(), SourceEnd::stopped);
    source_->stop();
    expect_running_count(sink_.stream());
}

TEST_F(UsbSourceTest, TheIdentityIsThatOfTheBoard) {
    plug_in();
    open("S1");
    const SourceIdentity& identity = source_->identity();
    EXPECT_EQ(identity.uri, "usb:S1");
    EXPECT_EQ(identity.vendor_id, GLP_USB_VENDOR_ID);
    EXPECT_EQ(identity.product_id, GLP_USB_PRODUCT_ID);
    EXPECT_EQ(identity.bus_number, 1);
    EXPECT_EQ(identity.device_address, 2);
    EXPECT_EQ(identity.manufacturer, "NXP");
    EXPECT_EQ(identity.product, "gyrolog MPU-9250");
    EXPECT_EQ(identity.device_descriptor.size(), 18U);
    EXPECT_EQ(identity.configuration_descriptor, test::cdc_acm_configuration(0x81, 0x01));
}

TEST_F(UsbSourceTest, EveryTransferIsToldOnceAndInTheKernelsOrder) {
    plug_in();
    open();
    start();
    raise_line();
    EXPECT_TRUE(sink_.wait_for_bytes(4000));
    const std::uint8_t command[] = {1, 2, 3};
    ASSERT_TRUE(source_->write(command).ok());
    source_->stop();

    const auto told = sink_.told();
    ASSERT_GE(told.size(), 12U);
    // DTR down before anything else; then the whole queue; then DTR up; only then data.
    EXPECT_EQ(told[0].transfer.kind, TransferKind::control);
    EXPECT_EQ(told[0].transfer.setup, (std::array<std::uint8_t, 8>{0x21, 0x22, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(told[1].transfer.event, Transfer::Event::completion);
    EXPECT_EQ(told[1].transfer.kind, TransferKind::control);
    for (std::size_t i = 2; i < 10; ++i) {
        EXPECT_EQ(told[i].transfer.event, Transfer::Event::submission);
        EXPECT_EQ(told[i].transfer.endpoint, 0x81);
        EXPECT_EQ(told[i].transfer.requested_bytes, 512U);
    }
    EXPECT_EQ(told[10].transfer.setup, (std::array<std::uint8_t, 8>{0x21, 0x22, 1, 0, 0, 0, 0, 0}));
    std::size_t written = 0;
    for (const auto& one : told) {
        if (one.transfer.endpoint != 0x01 || one.transfer.event != Transfer::Event::submission) { continue; }
        ++written;
        EXPECT_EQ(one.data, (Bytes{1, 2, 3}));
    }
    EXPECT_EQ(written, 1U);
    EXPECT_EQ(function_.received, (Bytes{1, 2, 3}));
    for (std::size_t i = 1; i < told.size(); ++i) {
        EXPECT_LE(told[i - 1].transfer.time.monotonic_ns, told[i].transfer.time.monotonic_ns);
    }
}

TEST_F(UsbSourceTest, StartQuietsABoardLeftStreamingAndTellsWhatItHadQueued) {
    function_.stale_bytes = 192;
    plug_in();
    open();
    const auto before = std::chrono::steady_clock::now();
    start();
    EXPECT_GE(std::chrono::steady_clock::now() - before, std::chrono::milliseconds(50))
        << "the time to arrive";
    EXPECT_FALSE(function_.dtr);
    EXPECT_TRUE(sink_.wait_for_bytes(192));
}

TEST_F(UsbSourceTest, TheKernelsDriverGetsTheBoardBack) {
    const UmockdevBoard& board = plug_in();
    open();
    EXPECT_FALSE(board.kernel_driver_bound());
    EXPECT_TRUE(board.interface_claimed(0));
    EXPECT_TRUE(board.interface_claimed(1));
    start();
    raise_line();
    source_.reset();
    EXPECT_FALSE(function_.dtr) << "nobody listens any more";
    EXPECT_FALSE(board.interface_claimed(0));
    EXPECT_FALSE(board.interface_claimed(1));
    EXPECT_TRUE(board.kernel_driver_bound());
}

TEST_F(UsbSourceTest, AKernelThatCannotNameTheDriverIsNoObstacle) {
    UmockdevBoard& board = plug_in();
    board.hide_driver();
    open();
    EXPECT_TRUE(board.interface_claimed(1));
}

TEST_F(UsbSourceTest, PullingTheCableEndsTheStreamAndNothingHangs) {
    UmockdevBoard& board = plug_in();
    open();
    start();
    raise_line();
    EXPECT_TRUE(sink_.wait_for_bytes(4000));
    board.unplug();
    EXPECT_EQ(sink_.wait_for_end(), SourceEnd::device_lost);
    EXPECT_THAT(sink_.error_message(), HasSubstr("went away"));
    source_->stop();
    EXPECT_EQ(source_->set_line_state(false).error().code, ErrorCode::device_lost);
    EXPECT_EQ(source_->write(as_bytes("x")).error().code, ErrorCode::device_lost);
    expect_running_count(sink_.stream());
    const std::uint64_t asked = board.ioctls();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(sink_.end(), SourceEnd::device_lost);
    EXPECT_LE(board.ioctls() - asked, 2000U);
    EXPECT_EQ(refusal("S1").code, ErrorCode::not_found) << "it is no longer listed";
}

TEST_F(UsbSourceTest, ABoardThatIsPluggedInAgainIsFoundAndStreamsAgain) {
    UmockdevBoard& board = plug_in();
    open("S1");
    start();
    board.unplug();
    EXPECT_EQ(sink_.wait_for_end(), SourceEnd::device_lost);
    source_.reset();

    MockUsbIdentity again;
    again.device_address = 7;
    plug_in(again);
    // libusb hears of it on a thread of its own.
    for (int attempt = 0; attempt < 500 && source_ == nullptr; ++attempt) {
        auto found = UsbSource::open(usb_, "S1", few_transfers);
        if (found.ok()) { source_ = std::move(found).value(); }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_NE(source_, nullptr);
    EXPECT_EQ(source_->identity().device_address, 7);
    CollectingSink sink;
    ASSERT_TRUE(source_->start(sink).ok());
    raise_line();
    EXPECT_TRUE(sink.wait_for_bytes(400));
    source_->stop();
}

TEST_F(UsbSourceTest, AStalledEndpointIsClearedAndTheStreamGoesOn) {
    int turn = 0;
    function_.script = [&turn](CountingFunction& self, std::size_t) -> std::optional<MockUsbFunction::In> {
        if (++turn == 20) { return MockUsbFunction::In{-EPIPE, {}}; }
        return MockUsbFunction::In{0, self.count(40)};
    };
    const UmockdevBoard& board = plug_in();
    open();
    start();
    raise_line();
    EXPECT_TRUE(sink_.wait_for_bytes(4000));
    source_->stop();
    EXPECT_EQ(board.cleared_halts(), 1U);
    expect_running_count(sink_.stream());
}

TEST_F(UsbSourceTest, BabbleAndBusErrorsCostNoByteThatArrived) {
    int turn = 0;
    function_.script = [&turn](CountingFunction& self, std::size_t) -> std::optional<MockUsbFunction::In> {
        ++turn;
        if (turn == 10) { return MockUsbFunction::In{-EOVERFLOW, self.count(64)}; }
        if (turn == 20) { return MockUsbFunction::In{-EPROTO, self.count(64)}; }
        if (turn == 30) { return MockUsbFunction::In{-EILSEQ, {}}; }
        return MockUsbFunction::In{0, self.count(40)};
    };
    plug_in();
    open();
    start();
    raise_line();
    EXPECT_TRUE(sink_.wait_for_bytes(4000));
    source_->stop();
    expect_running_count(sink_.stream());
}

TEST_F(UsbSourceTest, AFrameThatFillsItsTransferArrivesWithTheEmptyPacketBehindIt) {
    bool owes_empty_packet = false;
    std::size_t frames = 0;
    function_.script = [&](CountingFunction& self,
                           std::size_t requested) -> std::optional<MockUsbFunction::In> {
        owes_empty_packet = !owes_empty_packet;
        if (!owes_empty_packet) { return MockUsbFunction::In{}; }
        if (++frames > 16) { return std::nullopt; }
        return MockUsbFunction::In{0, self.count(std::min<std::size_t>(requested, 64 * (frames % 8 + 1)))};
    };
    plug_in();
    open();
    start();
    raise_line();
    EXPECT_TRUE(sink_.wait_for_bytes(std::size_t{2} * 64 * (1 + 2 + 3 + 4 + 5 + 6 + 7 + 8)));
    source_->stop();
    EXPECT_EQ(sink_.end(), SourceEnd::stopped);
    expect_running_count(sink_.stream());
}

TEST_F(UsbSourceTest, ASilentBoardIsStoppedAtOnce) {
    function_.script = [](CountingFunction&, std::size_t) { return std::nullopt; };
    plug_in();
    open();
    start();
    raise_line();
    const auto before = std::chrono::steady_clock::now();
    source_->stop();
    EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(1));
    EXPECT_EQ(sink_.end(), SourceEnd::stopped);
    EXPECT_EQ(sink_.stream().size(), 0U);
}

TEST_F(UsbSourceTest, ABoardWithoutLineStateIsStartedByCommands) {
    function_.refuses_line_state = true;
    function_.dtr = false;
    plug_in();
    open();
    start();
    EXPECT_EQ(source_->set_line_state(true).error().code, ErrorCode::unsupported);
    EXPECT_TRUE(source_->write(as_bytes("start")).ok());
}

TEST_F(UsbSourceTest, TwoBoardsAreToldApartAndStreamSideBySide) {
    plug_in();
    MockUsbIdentity other;
    other.device_address = 3;
    other.serial = "S2";
    plug_in(other, second_function_);
    open("S1");
    const Error ambiguous = refusal("");
    EXPECT_EQ(ambiguous.code, ErrorCode::invalid_argument);
    EXPECT_THAT(ambiguous.message, HasSubstr("usb:S1, usb:S2"));
    CollectingSink beside_sink;
    auto beside = UsbSource::open(usb_, "S2", few_transfers);
    ASSERT_TRUE(beside.ok()) << beside.error().message;
    EXPECT_EQ((*beside)->identity().device_address, 3);

    start();
    ASSERT_TRUE((*beside)->start(beside_sink).ok());
    raise_line();
    ASSERT_TRUE((*beside)->set_line_state(true).ok());
    EXPECT_TRUE(sink_.wait_for_bytes(4000));
    EXPECT_TRUE(beside_sink.wait_for_bytes(4000));
    source_->stop();
    (*beside)->stop();
    expect_running_count(sink_.stream());
    expect_running_count(beside_sink.stream());
}

MockUsbIdentity with_former_id() {
    MockUsbIdentity identity;
    identity.vendor_id = GLP_USB_FORMER_VENDOR_ID;
    identity.product_id = GLP_USB_FORMER_PRODUCT_ID;
    return identity;
}

MockUsbIdentity nxp_example() {
    MockUsbIdentity identity = with_former_id();
    identity.product = "LPC VCOM";
    return identity;
}

MockUsbIdentity named_like_a_board() {
    MockUsbIdentity identity;
    identity.vendor_id = 0x0483;
    identity.product_id = 0x5740;
    return identity;
}

TEST_F(UsbSourceTest, ABoardWithTheFormerIdAndTheRightNameIsTaken) {
    plug_in(with_former_id());
    open();
    EXPECT_EQ(source_->identity().vendor_id, 0x1FC9);
}

// By the id alone, and by the name alone.
TEST_F(UsbSourceTest, AStrangersDeviceIsNeverTouched) {
    MockUsbIdentity own_id;
    own_id.product = "Somebody's keyboard";
    MockUsbIdentity nameless = with_former_id();
    nameless.product.clear();
    for (const MockUsbIdentity& identity : {nxp_example(), named_like_a_board(), own_id, nameless}) {
        SCOPED_TRACE(identity.product);
        const UmockdevBoard& stranger = plug_in(identity);
        start_libusb();
        const auto survey = survey_usb(*usb_);
        ASSERT_TRUE(survey.ok());
        EXPECT_TRUE(survey->boards.empty());
        ASSERT_EQ(survey->strangers.size(), 1U);
        EXPECT_EQ(survey->strangers[0].state, BoardState::wrong_protocol);
        EXPECT_THAT(survey->strangers[0].why, HasSubstr("left alone"));
        EXPECT_EQ(refusal("").code, ErrorCode::not_found);
        EXPECT_EQ(refusal("S1").code, ErrorCode::not_found) << "also by its serial number";
        EXPECT_TRUE(stranger.kernel_driver_bound());
        EXPECT_EQ(stranger.ioctls(), 0U) << "not even opened";
        usb_.reset();
        boards_.clear();
    }
}

TEST_F(UsbSourceTest, AStrangerIsNoneOfSeveralBoards) {
    const UmockdevBoard& stranger = plug_in(nxp_example());
    MockUsbIdentity board;
    board.device_address = 3;
    board.serial = "S2";
    plug_in(board, second_function_);
    open();
    EXPECT_EQ(source_->identity().serial, "S2");
    EXPECT_EQ(stranger.ioctls(), 0U);
}

TEST_F(UsbSourceTest, WhatAStrangerLacksIsSaid) {
    plug_in(nxp_example());
    start_libusb();
    EXPECT_THAT(refusal("").message,
                ::testing::AllOf(HasSubstr("looked for 1209:6779"), HasSubstr("1fc9:0083 NXP LPC VCOM"),
                                 HasSubstr("'LPC VCOM', which does not begin with 'gyrolog'")));
}

TEST_F(UsbSourceTest, EndpointsAreThoseOfTheDescriptor) {
    MockUsbIdentity identity;
    identity.configuration_descriptor = test::cdc_acm_configuration(0x82, 0x02, 0x81);
    plug_in(identity);
    open();
    start();
    raise_line();
    EXPECT_TRUE(sink_.wait_for_bytes(4000));
    ASSERT_TRUE(source_->write(as_bytes("command")).ok());
    source_->stop();
    expect_running_count(sink_.stream());
    EXPECT_EQ(as_text(function_.received), "command");
    for (const auto& one : sink_.told()) {
        if (one.transfer.kind != TransferKind::bulk) { continue; }
        EXPECT_EQ(one.transfer.endpoint & 0x7F, 2);
    }
}

TEST_F(UsbSourceTest, WhatIsLetGoIsTheDriversAgain) {
    const UmockdevBoard& board = plug_in();
    open();
    start();
    raise_line();
    source_->stop();
    source_->let_go();
    EXPECT_FALSE(function_.dtr);
    EXPECT_FALSE(board.interface_claimed(1));
    EXPECT_TRUE(board.kernel_driver_bound());
    EXPECT_EQ(source_->write(as_bytes("x")).error().code, ErrorCode::device_lost);
    ASSERT_TRUE(source_->reconnect().ok());
    EXPECT_FALSE(board.kernel_driver_bound());
}

// SPEC.md, 9.5: 50 ms from the last stale byte. When that comes, below 200 ms, is the board's affair.
TEST_F(UsbSourceTest, StartWaitsUntilABoardThatWasLeftStreamingIsSilent) {
    using std::chrono::milliseconds;
    function_.talks_on = milliseconds(200);
    plug_in();
    open();
    start();
    const std::int64_t started_ns = host_now().monotonic_ns;
    const Bytes stale = sink_.stream();
    ASSERT_FALSE(stale.empty());
    EXPECT_GE(started_ns - last_data_before(started_ns, sink_), 50'000'000);
    // Nothing of it comes later.
    std::this_thread::sleep_for(milliseconds(220));
    EXPECT_EQ(sink_.stream().size(), stale.size());
}

TEST_F(UsbSourceTest, StartDoesNotWaitForeverForABoardThatTalksOn) {
    using Clock = std::chrono::steady_clock;
    function_.talks_on = std::chrono::hours(1);
    plug_in();
    open();
    const auto before = Clock::now();
    start();
    const auto waited = Clock::now() - before;
    const std::int64_t started_ns = host_now().monotonic_ns;
    EXPECT_LT(waited, std::chrono::seconds(2));
    // A mocked board on a busy machine may pause for 50 ms: then it was silent.
    const bool was_silent = started_ns - last_data_before(started_ns, sink_) >= 50'000'000;
    EXPECT_TRUE(waited >= std::chrono::milliseconds(990) || was_silent)
        << std::chrono::duration_cast<std::chrono::milliseconds>(waited).count() << " ms";
}

TEST_F(UsbSourceTest, WhatIsFoundInsteadIsNamed) {
    MockUsbIdentity mouse;
    mouse.vendor_id = 0x046D;
    mouse.product_id = 0xC077;
    mouse.manufacturer = "Logitech";
    mouse.product = "USB Optical Mouse";
    bus_->add_bystander(mouse);
    start_libusb();
    const Error error = refusal("");
    EXPECT_EQ(error.code, ErrorCode::not_found);
    EXPECT_THAT(error.message, HasSubstr("046d:c077 Logitech USB Optical Mouse"));
}

TEST_F(UsbSourceTest, ABoardThatAnotherProgramHoldsIsBusy) {
    UmockdevBoard& board = plug_in();
    board.claim_elsewhere();
    start_libusb();
    const auto survey = survey_usb(*usb_);
    ASSERT_TRUE(survey.ok());
    ASSERT_EQ(survey->boards.size(), 1U);
    EXPECT_EQ(survey->boards[0].state, BoardState::busy);
    EXPECT_EQ(refusal("S1").code, ErrorCode::busy);
}

TEST_F(UsbSourceTest, LookingAtABoardLeavesItsDriverBound) {
    const UmockdevBoard& board = plug_in();
    start_libusb();
    const auto survey = survey_usb(*usb_);
    ASSERT_TRUE(survey.ok());
    ASSERT_EQ(survey->boards.size(), 1U);
    EXPECT_EQ(survey->boards[0].state, BoardState::ready);
    EXPECT_EQ(survey->boards[0].why, "");
    EXPECT_TRUE(board.kernel_driver_bound());
}

TEST_F(UsbSourceTest, DescriptorsThatAreNotABoardsAreRefusedWithTheReason) {
    MockUsbIdentity identity;
    identity.configuration_descriptor = test::cdc_acm_configuration(0x81, 0x83);
    plug_in(identity);
    start_libusb();
    const auto survey = survey_usb(*usb_);
    ASSERT_TRUE(survey.ok());
    ASSERT_EQ(survey->boards.size(), 1U);
    EXPECT_EQ(survey->boards[0].state, BoardState::wrong_protocol);
    const Error error = refusal("S1");
    EXPECT_EQ(error.code, ErrorCode::unsupported);
    EXPECT_THAT(error.message, HasSubstr("bulk OUT"));
}

TEST_F(UsbSourceTest, MissingPermissionNamesTheRuleThatMendsIt) {
    plug_in().forbid();
    start_libusb();
    constexpr uid_t nobody = 65534;
    const bool is_root = geteuid() == 0;
    if (is_root) { ASSERT_EQ(seteuid(nobody), 0); }
    const auto survey = survey_usb(*usb_);
    if (is_root) { ASSERT_EQ(seteuid(0), 0); }
    ASSERT_TRUE(survey.ok());
    ASSERT_EQ(survey->boards.size(), 1U);
    EXPECT_EQ(survey->boards[0].state, BoardState::no_permission);
    EXPECT_EQ(survey->boards[0].serial, "S1") << "known without opening it";
    const auto refused = choose_board(*survey, "S1");
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::permission_denied);
    for (const char* part : {"60-gyrolog.rules", "plug the board in again", "over ssh", "plugdev"}) {
        EXPECT_THAT(refused.error().message, HasSubstr(part));
    }
}

TEST_F(UsbSourceTest, TransfersThatAreNotWholePacketsAreRefused) {
    plug_in();
    start_libusb();
    const auto opened = UsbSource::open(usb_, "S1", BulkInPlan{8, 100});
    ASSERT_FALSE(opened.ok());
    EXPECT_EQ(opened.error().code, ErrorCode::invalid_argument);
}

TEST_F(UsbSourceTest, ASourceCanBeStartedAgain) {
    plug_in();
    open();
    for (int round = 0; round < 3; ++round) {
        CollectingSink sink;
        ASSERT_TRUE(source_->start(sink).ok());
        raise_line();
        EXPECT_TRUE(sink.wait_for_bytes(400));
        source_->stop();
        EXPECT_EQ(sink.end(), SourceEnd::stopped);
    }
}

TEST_F(UsbSourceTest, ABoardThatWasPulledIsTakenUpAgainByItsSerialNumber) {
    UmockdevBoard& board = plug_in();
    open();
    start();
    raise_line();
    EXPECT_TRUE(sink_.wait_for_bytes(400));
    board.unplug();
    EXPECT_EQ(sink_.wait_for_end(), SourceEnd::device_lost);
    source_->stop();
    EXPECT_EQ(source_->reconnect().error().code, ErrorCode::not_found);
    EXPECT_FALSE(source_->set_line_state(true).ok());
    CollectingSink early;
    EXPECT_FALSE(source_->start(early).ok());

    // Another board is none; the same one comes back under another address.
    MockUsbIdentity identity;
    identity.serial = "S2";
    identity.device_address = 3;
    plug_in(identity);
    EXPECT_EQ(source_->reconnect().error().code, ErrorCode::not_found);
    // The kernel has not read its descriptors yet.
    identity.serial = "S1";
    identity.device_address = 5;
    identity.configuration_descriptor = test::cdc_acm_configuration(0x81, 0x83);
    UmockdevBoard& unread = plug_in(identity);
    EXPECT_EQ(source_->reconnect().error().code, ErrorCode::busy);
    unread.unplug();
    identity.configuration_descriptor = {};
    identity.device_address = 4;
    CountingFunction again;
    const UmockdevBoard& back = plug_in(identity, again);
    EXPECT_TRUE(back.kernel_driver_bound());
    const Status taken = source_->reconnect();
    ASSERT_TRUE(taken.ok()) << taken.error().message;
    EXPECT_EQ(source_->identity().device_address, 4);
    CollectingSink sink;
    ASSERT_TRUE(source_->start(sink).ok());
    ASSERT_TRUE(source_->set_line_state(true).ok());
    EXPECT_TRUE(sink.wait_for_bytes(400));
    source_.reset();
    EXPECT_FALSE(again.dtr);
    EXPECT_TRUE(back.kernel_driver_bound()) << "/dev/ttyACM0 is there again";
}

TEST_F(UsbSourceTest, APortThatAKilledProgramTookAlongIsGivenBack) {
    UmockdevBoard& board = plug_in();
    board.lose_driver();
    open();
    source_.reset();
    EXPECT_TRUE(board.kernel_driver_bound());
}

TEST_F(UsbSourceTest, TheToleratedStallIsWhatTheQueueHolds) {
    plug_in();
    open();
    // Eight transfers at one frame of 40 bytes a millisecond; long frames count a transfer's 512 bytes.
    EXPECT_DOUBLE_EQ(source_->tolerated_stall_s(40'000.0, 40.0), 0.008);
    EXPECT_DOUBLE_EQ(source_->tolerated_stall_s(512'000.0, 1024.0), 0.008);
}

}  // namespace
}  // namespace gyrolog
