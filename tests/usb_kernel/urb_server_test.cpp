#include "tools/vhci_board/urb_server.hpp"

#include <cerrno>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <gyrolog_protocol/usb_identity.h>

#include "host/decode/stream_decoder.hpp"
#include "tools/vhci_board/session_log.hpp"

namespace gyrolog {
namespace {

using SetupPacket = std::array<std::uint8_t, 8>;
constexpr SetupPacket get_device_descriptor = {0x80, 6, 0, 1, 0, 0, 18, 0};
constexpr SetupPacket set_configuration = {0x00, 9, 1, 0, 0, 0, 0, 0};
constexpr SetupPacket dtr_on = {0x21, 0x22, 1, 0, 0, 0, 0, 0};
constexpr SetupPacket dtr_off = {0x21, 0x22, 0, 0, 0, 0, 0, 0};

struct Reply {
    std::uint32_t code = 0;  // 3: to a submit, 4: to an unlink
    int status = 0;
    Bytes data;
};

// The kernel's side of the link, with time in its own hands.
class Bus : public testing::Test {
protected:
    void plug(std::vector<LinkFault> faults = {}, const UsbEndpoints& endpoints = {}) {
        VirtualBoardOptions options;
        options.rate_hz = 1000.0;
        options.endpoints = endpoints;
        auto board = VirtualBoard::create(std::move(options));
        ASSERT_TRUE(board.ok()) << board.error().message;
        board_ = std::move(*board);
        function_ = std::make_unique<UsbFunction>(*board_);
        server_ = std::make_unique<UrbServer>(*function_, std::move(faults));
        function_->advance_to(0);
        control(set_configuration);
    }

    std::uint32_t submit(bool in, std::uint8_t endpoint, std::uint32_t requested_bytes,
                         const SetupPacket& setup = {}) {
        usbip::Submit submit;
        submit.sequence = ++sequence_;
        submit.in = in;
        submit.endpoint = endpoint;
        submit.requested_bytes = requested_bytes;
        submit.setup = setup;
        if (in) { in_transfers_.insert(submit.sequence); }
        server_->carry_out(submit);
        log_.observe(*board_);
        take_replies();
        return submit.sequence;
    }

    std::uint32_t submit_bulk_in() {
        return submit(true, static_cast<std::uint8_t>(board_->endpoints().in & 0x0FU), 512);
    }
    SetupPacket clear_halt() const { return {0x02, 1, 0, 0, board_->endpoints().in, 0, 0, 0}; }

    Reply control(const SetupPacket& setup) {
        const auto length = static_cast<std::uint32_t>(setup[6] | setup[7] << 8);
        return reply_to(submit((setup[0] & 0x80) != 0, 0, length, setup));
    }

    std::uint32_t unlink(std::uint32_t target) {
        server_->carry_out(usbip::Unlink{++sequence_, target});
        take_replies();
        return sequence_;
    }

    void advance_to(double time_s) {
        now_s_ = time_s;
        function_->advance_to(static_cast<std::int64_t>(time_s * 1e9));
        log_.observe(*board_);
        server_->serve(now_s_);
        take_replies();
    }

    // Lets the board stream with eight transfers on the queue, as a driver does, and feeds the decoder.
    void stream_until(double end_s) {
        for (; now_s_ < end_s; advance_to(now_s_ + 0.001)) {
            collect();
            while (queue_.size() < 8) { queue_.push_back(submit_bulk_in()); }
        }
        collect();
    }

    void collect() {
        while (!queue_.empty() && replied(queue_.front())) {
            const Reply reply = reply_to(queue_.front());
            queue_.pop_front();
            decoder_.feed(reply.data, HostTime{});
            statuses_.push_back(reply.status);
        }
    }

    void stop_stream() {
        control(dtr_off);
        stream_until(now_s_ + 0.2);
    }

    bool replied(std::uint32_t sequence) const { return replies_.contains(sequence); }
    Reply reply_to(std::uint32_t sequence) {
        EXPECT_TRUE(replied(sequence)) << "sequence " << sequence;
        return replies_[sequence];
    }

    std::unique_ptr<VirtualBoard> board_;
    std::unique_ptr<UsbFunction> function_;
    std::unique_ptr<UrbServer> server_;
    SessionLog log_;
    StreamDecoder decoder_;
    double now_s_ = 0.0;
    std::deque<std::uint32_t> queue_;
    std::vector<int> statuses_;

private:
    void take_replies() {
        const Bytes bytes = server_->take_replies();
        const auto word = [&](std::size_t at) {
            return (std::uint32_t{bytes[at]} << 24U) | (std::uint32_t{bytes[at + 1]} << 16U) |
                   (std::uint32_t{bytes[at + 2]} << 8U) | std::uint32_t{bytes[at + 3]};
        };
        for (std::size_t at = 0; at < bytes.size();) {
            Reply reply{word(at), static_cast<int>(word(at + 20)), {}};
            const std::uint32_t sequence = word(at + 4);
            const std::size_t data_bytes =
                reply.code == 3 && in_transfers_.contains(sequence) ? word(at + 24) : 0;
            at += usbip::header_bytes;
            reply.data.assign(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                              bytes.begin() + static_cast<std::ptrdiff_t>(at + data_bytes));
            at += data_bytes;
            EXPECT_TRUE(replies_.emplace(sequence, std::move(reply)).second) << "two replies to " << sequence;
        }
    }

    std::uint32_t sequence_ = 0;
    std::set<std::uint32_t> in_transfers_;  // whose replies carry data
    std::map<std::uint32_t, Reply> replies_;
};

TEST_F(Bus, TheBoardIsEnumerated) {
    plug();
    const Reply device = control(get_device_descriptor);
    EXPECT_EQ(device.status, 0);
    ASSERT_EQ(device.data.size(), 18U);
    EXPECT_EQ(device.data[8] | device.data[9] << 8, GLP_USB_VENDOR_ID);
    EXPECT_EQ(device.data[10] | device.data[11] << 8, GLP_USB_PRODUCT_ID);
}

TEST_F(Bus, ARequestTheBoardDoesNotKnowStalls) {
    plug();
    EXPECT_EQ(control({0xC0, 0x77, 0, 0, 0, 0, 8, 0}).status, -EPIPE);
}

TEST_F(Bus, ATransferWaitsUntilTheBoardHasSomethingToSend) {
    plug();
    const std::uint32_t transfer = submit_bulk_in();
    advance_to(1.0);
    EXPECT_FALSE(replied(transfer));
    control(dtr_on);
    advance_to(1.1);
    EXPECT_TRUE(replied(transfer));
}

TEST_F(Bus, TheStreamHoldsEverySampleThatTheBoardReports) {
    plug();
    control(dtr_on);
    stream_until(3.0);
    stop_stream();
    const LinkReport report = decoder_.report();
    ASSERT_EQ(log_.sessions().size(), 1U);
    EXPECT_NEAR(static_cast<double>(report.samples.good), 3000.0, 0.01 * 3000.0 + 1.0);
    EXPECT_EQ(report.samples.good, log_.sessions()[0].samples);
    EXPECT_EQ(log_.sessions()[0].samples_lost, 0U);
    EXPECT_TRUE(report.complete());
    EXPECT_EQ(report.frames.corrupted, 0U);
    EXPECT_EQ(report.bytes.skipped, 0U);
}

TEST_F(Bus, EndpointsAreThoseOfTheBoardsDescriptor) {
    plug({{LinkFaultKind::stall, 1.0}}, fixed_kind_endpoints);
    control(dtr_on);
    stream_until(1.1);
    EXPECT_EQ(statuses_.back(), -EPIPE);
    EXPECT_EQ(control({0x02, 1, 0, 0, 0x81, 0, 0, 0}).status, 0) << "the halt of another endpoint";
    stream_until(1.2);
    EXPECT_EQ(statuses_.back(), -EPIPE);
    EXPECT_EQ(control(clear_halt()).status, 0);
    stream_until(2.0);
    EXPECT_EQ(statuses_.back(), 0);
    const std::uint32_t notification = submit(true, 1, 8);
    submit(false, 2, 0);
    stop_stream();
    EXPECT_FALSE(replied(notification)) << "the board never sends one";
    EXPECT_GT(decoder_.report().samples.good, 1800U);
    EXPECT_EQ(decoder_.report().samples.missing, 0U);
}

TEST_F(Bus, SamplesThatTheHostLeavesAreReportedLost) {
    plug();
    control(dtr_on);
    stream_until(1.0);
    advance_to(4.0);
    stream_until(5.0);
    stop_stream();
    const LinkReport report = decoder_.report();
    ASSERT_EQ(log_.sessions().size(), 1U);
    EXPECT_GT(report.samples.missing, 1000U);
    EXPECT_GT(log_.sessions()[0].frames_lost, 0U);
}

TEST_F(Bus, EachStartIsASessionOfItsOwn) {
    plug();
    for (const double end_s : {1.0, 3.0}) {
        control(dtr_on);
        stream_until(end_s);
        stop_stream();
    }
    ASSERT_EQ(log_.sessions().size(), 2U);
    EXPECT_EQ(log_.sessions()[0].samples + log_.sessions()[1].samples, decoder_.report().samples.good);
}

TEST_F(Bus, AGivenUpTransferCostsNoByte) {
    plug();
    control(dtr_on);
    for (int round = 0; round < 50; ++round) {
        stream_until(now_s_ + 0.013);
        for (const std::uint32_t transfer : queue_) {
            const std::uint32_t unlinked = unlink(transfer);
            EXPECT_EQ(reply_to(unlinked).code, 4U);
            EXPECT_EQ(reply_to(unlinked).status, -ECONNRESET);
            EXPECT_FALSE(replied(transfer));
        }
        queue_.clear();
    }
    stop_stream();
    EXPECT_TRUE(decoder_.report().complete());
    EXPECT_EQ(decoder_.report().samples.good, log_.sessions().back().samples);
}

TEST_F(Bus, GivingUpATransferThatIsDoneIsAnsweredWithZero) {
    plug();
    const std::uint32_t transfer = submit(true, 0, 18, get_device_descriptor);
    EXPECT_EQ(reply_to(unlink(transfer)).status, 0);
}

TEST_F(Bus, BabbleAndABadChecksumFailOneTransferEachAndCostNoByte) {
    plug({{LinkFaultKind::crc, 1.0}, {LinkFaultKind::babble, 0.5}});
    control(dtr_on);
    stream_until(2.0);
    stop_stream();
    std::vector<int> failures;
    for (const int status : statuses_) {
        if (status != 0) { failures.push_back(status); }
    }
    EXPECT_EQ(failures, (std::vector<int>{-EOVERFLOW, -EPROTO}));
    EXPECT_TRUE(decoder_.report().complete());
    EXPECT_EQ(decoder_.report().samples.good, log_.sessions().back().samples);
}

TEST_F(Bus, AStallLastsUntilTheHostClearsIt) {
    plug({{LinkFaultKind::stall, 0.5}});
    control(dtr_on);
    stream_until(0.6);
    ASSERT_EQ(statuses_.back(), -EPIPE);
    EXPECT_EQ(control(clear_halt()).status, 0);
    queue_.clear();
    statuses_.clear();
    stream_until(1.0);
    stop_stream();
    for (const int status : statuses_) { EXPECT_EQ(status, 0); }
    EXPECT_EQ(decoder_.report().samples.good, log_.sessions().back().samples);
}

TEST_F(Bus, ATransferOfHalfAPacketIsTheHostsOwnBabble) {
    plug();
    control(dtr_on);
    const std::uint32_t transfer = submit(true, 1, 100);
    advance_to(0.1);
    EXPECT_EQ(reply_to(transfer).status, -EOVERFLOW);
}

}  // namespace
}  // namespace gyrolog
