#include "host/usb/bulk_in_stream.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/host/usb/fake_libusb.hpp"

namespace gyrolog {
namespace {

using test::FakeCompletion;
using test::FakeUsb;
using End = BulkInStream::End;

constexpr std::uint8_t endpoint = 0x81;
constexpr std::int64_t long_enough_ms = 10'000;

// Keeps the stream's bytes and the transfers' accounts, as a sink would.
class Listener : public TransferObserver {
public:
    void on_usb_transfer(const Transfer& transfer) override {
        const std::lock_guard lock(mutex_);
        if (transfer.event == Transfer::Event::submission) {
            EXPECT_TRUE(pending_.emplace(transfer.id, transfer.requested_bytes).second);
            return;
        }
        EXPECT_EQ(pending_.erase(transfer.id), 1U) << "a completion without its submission";
        ++statuses_[transfer.status];
        stream_.insert(stream_.end(), transfer.data.begin(), transfer.data.end());
    }

    Bytes stream() const {
        const std::lock_guard lock(mutex_);
        return stream_;
    }
    int count(int status) const {
        const std::lock_guard lock(mutex_);
        const auto found = statuses_.find(status);
        return found == statuses_.end() ? 0 : found->second;
    }
    std::size_t pending() const {
        const std::lock_guard lock(mutex_);
        return pending_.size();
    }

private:
    mutable std::mutex mutex_;
    std::map<std::uint64_t, std::uint32_t> pending_;
    std::map<int, int> statuses_;
    Bytes stream_;
};

std::optional<FakeCompletion> silence(std::uint64_t) { return std::nullopt; }
std::optional<FakeCompletion> frames_of_40_bytes(std::uint64_t) {
    return FakeCompletion{LIBUSB_TRANSFER_COMPLETED, 40};
}

class BulkInStreamTest : public ::testing::Test {
protected:
    void open(BulkInPlan plan = {8, 512}) {
        context_.reset();  // the fake has one event loop
        auto context = UsbContext::create();
        ASSERT_TRUE(context.ok());
        context_ = std::move(context).value();
        stream_ = std::make_unique<BulkInStream>(*context_, nullptr, endpoint, plan, listener_);
    }

    Status start() {
        ends_ = 0;
        return stream_->start([this](End end, const std::optional<Error>& error) {
            EXPECT_EQ(error.has_value(), end != End::stopped);
            if (error) { error_ = *error; }
            end_ = end;
            ++ends_;
        });
    }

    // What must hold however a stream went.
    void TearDown() override {
        stream_.reset();
        context_.reset();
        EXPECT_THAT(FakeUsb::bus().complaints(), ::testing::IsEmpty());
        EXPECT_EQ(listener_.pending(), 0U);
        const Bytes bytes = listener_.stream();
        for (std::size_t i = 0; i < bytes.size(); ++i) { ASSERT_EQ(bytes[i], i % 256) << "at byte " << i; }
    }

    void wait_for_completions(std::uint64_t count) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(long_enough_ms);
        while (FakeUsb::bus().completions() < count && std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
        ASSERT_GE(FakeUsb::bus().completions(), count);
    }

    void expect_end(End end) {
        ASSERT_TRUE(stream_->wait_for_end(long_enough_ms));
        EXPECT_EQ(ends_, 1);
        EXPECT_EQ(end_, end);
    }

    Listener listener_;
    std::unique_ptr<UsbContext> context_;
    std::unique_ptr<BulkInStream> stream_;
    std::atomic<int> ends_{0};
    std::atomic<End> end_{End::failed};
    Error error_{ErrorCode::failed, {}};
};

TEST_F(BulkInStreamTest, KeepsAllTransfersQueuedAndTheBytesInOrder) {
    FakeUsb::bus().reset(frames_of_40_bytes);
    open();
    ASSERT_TRUE(start().ok());
    wait_for_completions(5000);
    stream_->stop();
    expect_end(End::stopped);
    EXPECT_EQ(FakeUsb::bus().most_in_flight(), 8U);
    EXPECT_EQ(listener_.stream().size(), 40 * FakeUsb::bus().completions());
}

TEST_F(BulkInStreamTest, StartsAndStopsTwoHundredTimesWithCallbacksUnderWay) {
    FakeUsb::bus().reset(frames_of_40_bytes);
    open();
    for (int round = 0; round < 200; ++round) {
        FakeUsb::bus().delay_cancellations(static_cast<unsigned>(round % 4));
        ASSERT_TRUE(start().ok()) << "round " << round;
        if (round % 3 == 0) { wait_for_completions(FakeUsb::bus().completions() + 1); }
        stream_->stop();
        ASSERT_EQ(ends_, 1) << "round " << round;
        ASSERT_EQ(end_, End::stopped);
    }
}

TEST_F(BulkInStreamTest, DestructionStopsAStreamThatRuns) {
    FakeUsb::bus().reset(frames_of_40_bytes);
    for (int round = 0; round < 20; ++round) {
        open();
        ASSERT_TRUE(start().ok());
        stream_.reset();
        EXPECT_EQ(ends_, 1);
    }
}

TEST_F(BulkInStreamTest, StopWaitsForCallbacksThatComeLate) {
    FakeUsb::bus().reset(silence);
    FakeUsb::bus().delay_cancellations(50);
    open();
    ASSERT_TRUE(start().ok());
    stream_->stop();
    EXPECT_EQ(listener_.count(-ENOENT), 8);
    EXPECT_EQ(listener_.pending(), 0U);
}

TEST_F(BulkInStreamTest, StopFromTwoThreadsEndsOnce) {
    FakeUsb::bus().reset(frames_of_40_bytes);
    open();
    ASSERT_TRUE(start().ok());
    std::thread other([this] { stream_->stop(); });
    stream_->stop();
    other.join();
    EXPECT_EQ(ends_, 1);
}

TEST_F(BulkInStreamTest, UnpluggingAfterAnyNumberOfTransfersEndsTheStream) {
    for (std::uint64_t n = 0; n < 20; ++n) {
        FakeUsb::bus().reset([n](std::uint64_t completion) -> std::optional<FakeCompletion> {
            if (completion < n) { return FakeCompletion{LIBUSB_TRANSFER_COMPLETED, 64}; }
            return FakeCompletion{LIBUSB_TRANSFER_NO_DEVICE, 0};
        });
        Listener fresh;
        open();
        stream_ = std::make_unique<BulkInStream>(*context_, nullptr, endpoint, BulkInPlan{8, 512}, fresh);
        ASSERT_TRUE(start().ok());
        expect_end(End::device_lost);
        EXPECT_EQ(error_.code, ErrorCode::device_lost);
        EXPECT_THAT(error_.message, ::testing::HasSubstr("went away"));
        EXPECT_EQ(fresh.stream().size(), 64 * n);
        stream_->stop();
        EXPECT_EQ(ends_, 1) << "stopping what has ended changes nothing";
        stream_.reset();
    }
}

TEST_F(BulkInStreamTest, ADeviceThatIsGoneBeforeTheStartIsAnError) {
    FakeUsb::bus().reset(silence);
    FakeUsb::bus().unplug();
    open();
    const Status started = start();
    ASSERT_FALSE(started.ok());
    EXPECT_EQ(started.error().code, ErrorCode::device_lost);
    EXPECT_EQ(ends_, 0);
}

TEST_F(BulkInStreamTest, QueueThatIsDeepenedInTheMiddleLosesNoByte) {
    for (const BulkInPlan deeper : {BulkInPlan{300, 512}, BulkInPlan{40, 16384}}) {
        Listener fresh;
        FakeUsb::bus().reset(frames_of_40_bytes);
        open();
        stream_ = std::make_unique<BulkInStream>(*context_, nullptr, endpoint, BulkInPlan{8, 512}, fresh);
        EXPECT_EQ(stream_->capacity_bytes(40.0), 8 * 40.0);
        ASSERT_TRUE(start().ok());
        wait_for_completions(500);
        stream_->deepen(deeper);
        EXPECT_EQ(stream_->capacity_bytes(40.0), deeper.transfers * 40.0);
        wait_for_completions(3000);
        EXPECT_EQ(FakeUsb::bus().most_in_flight(), 8U + deeper.transfers);
        stream_->stop();
        expect_end(End::stopped);
        const Bytes bytes = fresh.stream();
        EXPECT_EQ(bytes.size(), 40 * FakeUsb::bus().completions());
        for (std::size_t i = 0; i < bytes.size(); ++i) { ASSERT_EQ(bytes[i], i % 256) << "at byte " << i; }
        EXPECT_EQ(fresh.pending(), 0U);
        stream_.reset();
    }
}

TEST_F(BulkInStreamTest, GoesOnWithFewerTransfersWhenMemoryIsShort) {
    FakeUsb::bus().reset(
        silence, [](std::uint64_t attempt) { return attempt < 3 ? LIBUSB_SUCCESS : LIBUSB_ERROR_NO_MEM; });
    open();
    ASSERT_TRUE(start().ok());
    EXPECT_EQ(stream_->capacity_bytes(40.0), 3 * 40.0);
    // A deeper queue that there is no memory for leaves the one that is there.
    stream_->deepen({100, 1024});
    EXPECT_EQ(stream_->capacity_bytes(40.0), 3 * 40.0);
    stream_->stop();
}

TEST_F(BulkInStreamTest, NoMemoryForASingleTransferFailsTheStartAndSaysWhatToRaise) {
    FakeUsb::bus().reset(silence, [](std::uint64_t) { return LIBUSB_ERROR_NO_MEM; });
    open();
    const Status started = start();
    ASSERT_FALSE(started.ok());
    EXPECT_THAT(started.error().message, ::testing::HasSubstr("usbfs_memory_mb"));
}

TEST_F(BulkInStreamTest, LosingEveryTransferToLackOfMemoryEndsTheStream) {
    FakeUsb::bus().reset(frames_of_40_bytes, [](std::uint64_t attempt) {
        return attempt < 8 ? LIBUSB_SUCCESS : LIBUSB_ERROR_NO_MEM;
    });
    open();
    ASSERT_TRUE(start().ok());
    expect_end(End::failed);
    EXPECT_EQ(listener_.stream().size(), 8U * 40U) << "what was queued still arrives";
}

TEST_F(BulkInStreamTest, AStallIsClearedWithNothingInFlightAndTheStreamGoesOn) {
    FakeUsb::bus().reset([](std::uint64_t completion) -> std::optional<FakeCompletion> {
        if (completion == 10) { return FakeCompletion{LIBUSB_TRANSFER_STALL, 0}; }
        return FakeCompletion{LIBUSB_TRANSFER_COMPLETED, 40};
    });
    open();
    ASSERT_TRUE(start().ok());
    wait_for_completions(100);
    stream_->stop();
    EXPECT_EQ(FakeUsb::bus().clear_halts(), 1U);
    EXPECT_EQ(listener_.count(-EPIPE), 1);
}

TEST_F(BulkInStreamTest, AnEndpointThatAlwaysStallsIsGivenUp) {
    FakeUsb::bus().reset([](std::uint64_t) { return FakeCompletion{LIBUSB_TRANSFER_STALL, 0}; });
    open();
    ASSERT_TRUE(start().ok());
    expect_end(End::failed);
    EXPECT_EQ(FakeUsb::bus().clear_halts(), BulkInStream::stall_limit);
}

TEST_F(BulkInStreamTest, ADeviceLostWhileItsHaltIsClearedIsLost) {
    FakeUsb::bus().reset([](std::uint64_t) { return FakeCompletion{LIBUSB_TRANSFER_STALL, 0}; });
    FakeUsb::bus().answer_clear_halt(LIBUSB_ERROR_NO_DEVICE);
    open();
    ASSERT_TRUE(start().ok());
    expect_end(End::device_lost);
}

TEST_F(BulkInStreamTest, DataThatComeWithAnErrorAreKept) {
    FakeUsb::bus().reset([](std::uint64_t completion) -> std::optional<FakeCompletion> {
        if (completion == 5) { return FakeCompletion{LIBUSB_TRANSFER_OVERFLOW, 512}; }
        if (completion == 6) { return FakeCompletion{LIBUSB_TRANSFER_ERROR, 64}; }
        if (completion < 20) { return FakeCompletion{LIBUSB_TRANSFER_COMPLETED, 40}; }
        return std::nullopt;
    });
    open();
    ASSERT_TRUE(start().ok());
    wait_for_completions(20);
    stream_->stop();
    EXPECT_EQ(listener_.stream().size(), 18U * 40U + 512U + 64U);
    EXPECT_EQ(listener_.count(-EOVERFLOW), 1);
    EXPECT_EQ(listener_.count(-EPROTO), 1);
}

TEST_F(BulkInStreamTest, AGlitchThatSpoilsEveryQueuedTransferIsRiddenOut) {
    FakeUsb::bus().reset([](std::uint64_t completion) {
        const bool glitch = completion % 100 < 8;
        return FakeCompletion{glitch ? LIBUSB_TRANSFER_ERROR : LIBUSB_TRANSFER_COMPLETED, glitch ? 0 : 40};
    });
    open();
    ASSERT_TRUE(start().ok());
    wait_for_completions(1000);
    EXPECT_EQ(ends_, 0);
    stream_->stop();
    expect_end(End::stopped);
}

TEST_F(BulkInStreamTest, AStormOfErrorsMeansThatTheDeviceIsLost) {
    FakeUsb::bus().reset([](std::uint64_t) { return FakeCompletion{LIBUSB_TRANSFER_ERROR, 0}; });
    open();
    ASSERT_TRUE(start().ok());
    expect_end(End::device_lost);
    EXPECT_LE(FakeUsb::bus().completions(), 20U);
}

TEST_F(BulkInStreamTest, AFloodOfEmptyPacketsEndsInsteadOfSpinning) {
    FakeUsb::bus().reset([](std::uint64_t) { return FakeCompletion{LIBUSB_TRANSFER_COMPLETED, 0}; });
    open();
    ASSERT_TRUE(start().ok());
    expect_end(End::failed);
    EXPECT_EQ(error_.code, ErrorCode::malformed);
}

TEST_F(BulkInStreamTest, AnEmptyPacketAfterEachFullFrameIsOrdinary) {
    FakeUsb::bus().reset([](std::uint64_t completion) {
        return FakeCompletion{LIBUSB_TRANSFER_COMPLETED, completion % 2 == 0 ? 512 : 0};
    });
    open();
    ASSERT_TRUE(start().ok());
    wait_for_completions(4000);
    EXPECT_EQ(ends_, 0);
    stream_->stop();
}

TEST_F(BulkInStreamTest, ASilentBoardCostsNoWork) {
    FakeUsb::bus().reset(silence);
    open();
    ASSERT_TRUE(start().ok());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    // The fake looks at a silent board each 200 us; a spinning loop would come by far more often.
    EXPECT_LE(FakeUsb::bus().event_turns(), 1000U);
    EXPECT_EQ(listener_.stream().size(), 0U);
}

TEST(BulkInPlan, CoversTwoSecondsOfFramesWithinItsBounds) {
    EXPECT_EQ(BulkInPlan::for_short_packets(1000.0).transfers, 2000U);
    EXPECT_EQ(BulkInPlan::for_short_packets(62.5).transfers, 125U);
    EXPECT_EQ(BulkInPlan::for_short_packets(1.0).transfers, 32U);
    EXPECT_EQ(BulkInPlan::for_short_packets(8000.0).transfers, 2048U);
    EXPECT_EQ(BulkInPlan::for_short_packets(1000.0).transfer_bytes % 64U, 0U);
    // 40 samples of 12 bytes: 25 frames a second, each in one transfer.
    EXPECT_EQ(BulkInPlan::for_stream(13'125.0, 525.0, 2.5).transfers, 63U);
    EXPECT_EQ(BulkInPlan::for_stream(13'125.0, 525.0, 2.5).transfer_bytes, 1024U);
    EXPECT_EQ(BulkInPlan::for_stream(60'000.0, 60.0, 2.5).transfers, 2500U);
    EXPECT_EQ(BulkInPlan::for_stream(60'000.0, 60.0, 2.5).transfer_bytes, 512U);
    // The bus to its brim: full packets, and 2.5 s of them.
    EXPECT_EQ(BulkInPlan::for_stream(1'216'000.0, 1000.0, 2.5).transfers, 186U);
    EXPECT_EQ(BulkInPlan::for_stream(1'216'000.0, 1000.0, 2.5).transfer_bytes, 16384U);
    // usbfs has 16 MiB for the whole system.
    EXPECT_EQ(BulkInPlan::for_stream(480'000.0, 60.0, 2.5).transfers, 8192U);
}

}  // namespace
}  // namespace gyrolog
