// The USB source with all of its threads, on a fake of libusb's calls: nothing is preloaded, so that
// ThreadSanitizer sees the event thread, submission, cancellation, unplugging and teardown.

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/session/capture_session.hpp"
#include "host/session/load_capture.hpp"
#include "host/transport/usb_source.hpp"
#include "tests/host/usb/fake_libusb.hpp"
#include "tests/support/collecting_sink.hpp"
#include "tests/support/program.hpp"
#include "tests/support/umockdev_virtual_board.hpp"

namespace gyrolog {
namespace {

using std::chrono::milliseconds;
using test::CollectingSink;
using test::FakeUsb;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr BulkInPlan few_transfers{8, 512};

UsbBoard board_at(std::uint8_t address) {
    UsbBoard board;
    board.bus_number = 1;
    board.device_address = address;
    board.serial = "S1";
    board.configuration_descriptor = configuration_descriptor();
    auto layout = parse_cdc_configuration(board.configuration_descriptor);
    EXPECT_TRUE(layout.ok());
    if (layout.ok()) { board.layout = *layout; }
    return board;
}

Result<std::unique_ptr<UsbSource>> open_at(std::uint8_t address) {
    GYROLOG_TRY(std::shared_ptr<UsbContext> usb, UsbContext::create());
    return UsbSource::open(std::move(usb), board_at(address), few_transfers);
}

// A USB source that looks for its board at the fake's addresses, where no sysfs tells of any.
class SourceOnFake final : public ByteSource {
public:
    explicit SourceOnFake(std::unique_ptr<UsbSource> source)
        : source_(std::move(source)), identity_(source_->identity()) {}

    const SourceIdentity& identity() const override { return identity_; }
    bool can_wait() const override { return false; }
    double tolerated_stall_s(double bytes_per_s, double bytes_per_frame) const override {
        return source_->tolerated_stall_s(bytes_per_s, bytes_per_frame);
    }
    void expect(double bytes_per_s, double bytes_per_frame) override {
        source_->expect(bytes_per_s, bytes_per_frame);
    }
    Status start(TransferSink& sink) override { return source_->start(sink); }
    Status set_line_state(bool raised) override { return source_->set_line_state(raised); }
    Status write(ByteView bytes) override { return source_->write(bytes); }
    void stop() override {
        if (source_) { source_->stop(); }
    }
    Status reconnect() override {
        source_.reset();
        for (const auto address : {std::uint8_t{2}, std::uint8_t{3}}) {
            auto again = open_at(address);
            if (!again.ok()) { continue; }
            source_ = std::move(again).value();
            return {};
        }
        return Error{ErrorCode::not_found, "no board on the fake's bus"};
    }

private:
    std::unique_ptr<UsbSource> source_;
    SourceIdentity identity_;
};

// CollectingSink wants to be told the end of each request, and a request that is under way at the end is not.
class EndCount final : public TransferSink {
public:
    bool on_transfer(const Transfer& /*transfer*/) override {
        EXPECT_EQ(ends_, 0) << "told after the end";
        return true;
    }
    void on_end(SourceEnd end, const std::optional<Error>& /*error*/) override {
        EXPECT_EQ(end, SourceEnd::stopped);
        ++ends_;
    }
    int ends() const { return ends_; }

private:
    std::atomic<int> ends_ = 0;
};

class UsbSourceThreads : public testing::Test {
protected:
    UsbSourceThreads() {
        FakeUsb::bus().reset({});
        VirtualBoardOptions options;
        options.rate_hz = 1000.0;
        options.dlpf_hz = 184;
        options.self_powered = true;
        auto board = VirtualBoard::create(std::move(options));
        EXPECT_TRUE(board.ok());
        board_ = std::move(board).value();
        function_ = std::make_unique<test::VirtualBoardOnMock>(*board_);
        FakeUsb::bus().plug_in(function_.get());
        request_.path = folder_.path("a.pcapng");
        request_.duration_s = 1.0;
        request_.reconnect_interval_s = 0.02;
    }
    void TearDown() override {
        source_.reset();
        EXPECT_THAT(FakeUsb::bus().complaints(), IsEmpty());
    }

    void open() {
        auto source = open_at(2);
        ASSERT_TRUE(source.ok()) << source.error().message;
        source_ = std::move(source).value();
    }
    Result<CaptureOutcome> capture(const std::function<void(const CaptureProgress&)>& meanwhile = {}) {
        auto opened = open_at(2);
        if (!opened.ok()) { return opened.error(); }
        SourceOnFake source(std::move(opened).value());
        return run_capture(source, request_, [&](const CaptureProgress& progress) {
            if (meanwhile) { meanwhile(progress); }
            return progress.elapsed_s < 20.0;
        });
    }

    TemporaryFolder folder_;
    CaptureRequest request_;
    std::unique_ptr<VirtualBoard> board_;
    std::unique_ptr<test::VirtualBoardOnMock> function_;
    std::unique_ptr<UsbSource> source_;
};

TEST_F(UsbSourceThreads, ACaptureLosesNothing) {
    request_.configure.rate_mHz = 500'000;
    const auto outcome = capture();
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_TRUE(outcome->link.complete());
    EXPECT_EQ(outcome->transfers_dropped, 0U);
    EXPECT_GE(outcome->link.samples.good, 500U);
    EXPECT_GT(FakeUsb::bus().most_in_flight(), few_transfers.transfers) << "the queue was deepened meanwhile";
    const auto stored = load_capture(request_.path, false);
    ASSERT_TRUE(stored.ok());
    EXPECT_EQ(stored->decoder->report().samples.good, outcome->link.samples.good);
}

TEST_F(UsbSourceThreads, ACableThatIsPulledAndPutBackIsOneCapture) {
    request_.on_unplug = OnUnplug::wait;
    request_.duration_s = 1.5;
    bool pulled = false;
    const auto outcome = capture([&](const CaptureProgress& progress) {
        if (!pulled && !progress.parked && progress.samples > 300) {
            FakeUsb::bus().unplug();
            pulled = true;
        } else if (progress.parked && progress.parked_s > 0.2) {
            FakeUsb::bus().plug_in(function_.get(), 3);
        }
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_EQ(outcome->progress.connections, 2U);
    EXPECT_EQ(outcome->paths.size(), 2U);
    EXPECT_GT(outcome->link.samples.good, 700U);
}

TEST_F(UsbSourceThreads, CommandsFromOneThreadAndStopsFromAnotherMeet) {
    open();
    for (int round = 0; round < 12; ++round) {
        FakeUsb::bus().delay_cancellations(static_cast<unsigned>(round % 3));
        EndCount sink;
        ASSERT_TRUE(source_->start(sink).ok());
        std::atomic<bool> done = false;
        std::thread caller([&] {
            for (int i = 0; !done || i < 3; ++i) {
                EXPECT_TRUE(source_->set_line_state(i % 2 == 0).ok());
                EXPECT_TRUE(source_->write(Bytes(3, 0)).ok());
            }
        });
        std::this_thread::sleep_for(milliseconds(round));
        source_->stop();
        done = true;
        caller.join();
        EXPECT_EQ(sink.ends(), 1);
    }
}

// Twice, farther apart than the second that is ridden out: all was well between them.
TEST_F(UsbSourceThreads, EventsThatFailForAMomentCostNothing) {
    request_.duration_s = 1.8;
    std::uint64_t next = 50;
    unsigned moments = 0;
    const auto outcome = capture([&](const CaptureProgress& progress) {
        if (progress.samples <= next) { return; }
        FakeUsb::bus().fail_events(LIBUSB_ERROR_IO, 20);
        next = progress.samples + 1200;
        ++moments;
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(moments, 2U);
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_TRUE(outcome->link.complete());
}

TEST_F(UsbSourceThreads, EventsThatFailForGoodAreALostDeviceWithTheReason) {
    std::uint64_t turns_before = 0;
    const auto outcome = capture([&](const CaptureProgress& progress) {
        if (turns_before == 0 && progress.samples > 300) {
            turns_before = FakeUsb::bus().event_turns();
            FakeUsb::bus().fail_events(LIBUSB_ERROR_IO);
        }
    });
    const std::uint64_t turns = FakeUsb::bus().event_turns() - turns_before;
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::device_lost);
    ASSERT_TRUE(outcome->error.has_value());
    EXPECT_EQ(outcome->error->code, ErrorCode::device_lost);
    EXPECT_THAT(outcome->error->message, HasSubstr("USB"));
    EXPECT_THAT(outcome->error->message, HasSubstr("input/output error"));
    EXPECT_LT(outcome->progress.elapsed_s, 5.0);
    EXPECT_LE(turns, 200U) << "a hundred a second: it does not spin";
    const auto stored = load_capture(request_.path, false);
    ASSERT_TRUE(stored.ok());
    EXPECT_EQ(stored->file.blocks.end, FileEnd::clean);
    EXPECT_GT(stored->decoder->report().samples.good, 300U);
}

TEST_F(UsbSourceThreads, EventsThatFailForGoodAreWaitedForAsALostBoard) {
    request_.on_unplug = OnUnplug::wait;
    request_.duration_s = 2.5;
    bool failed = false;
    const auto outcome = capture([&](const CaptureProgress& progress) {
        if (!failed && progress.samples > 300) {
            FakeUsb::bus().fail_events(LIBUSB_ERROR_OTHER);
            failed = true;
        } else if (progress.parked) {
            FakeUsb::bus().fail_events(LIBUSB_SUCCESS);
        }
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_EQ(outcome->progress.connections, 2U);
}

TEST_F(UsbSourceThreads, NobodyWaitsForAnAnswerThatCannotCome) {
    open();
    CollectingSink sink;
    ASSERT_TRUE(source_->start(sink).ok());
    FakeUsb::bus().fall_silent();
    std::thread breaker([] {
        std::this_thread::sleep_for(milliseconds(50));
        FakeUsb::bus().fail_events(LIBUSB_ERROR_NO_MEM);
    });
    EXPECT_FALSE(source_->write(Bytes(3, 0)).ok());
    breaker.join();
    EXPECT_EQ(sink.wait_for_end(), SourceEnd::device_lost);
    EXPECT_FALSE(source_->set_line_state(true).ok());
    source_->stop();
    CollectingSink again;
    EXPECT_EQ(source_->start(again).error().code, ErrorCode::failed);
}

}  // namespace
}  // namespace gyrolog
