// Every frame and sample is accounted for, and blamed on the right part of the way.
#include <algorithm>
#include <type_traits>

#include <gtest/gtest.h>

#include "tests/host/decode/made_stream.hpp"

namespace gyrolog {
namespace {

TEST(LinkAccounts, ACleanStreamBalancesAndMissesNothing) {
    Listening link;
    link.begin();
    link.hear_samples(100);
    link.hear(link.board.status_frame());
    link.hear(link.board.event_frame(glp_event_text));
    link.hear_samples(50);
    link.hear(link.board.event_frame(glp_event_stopped));
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.bytes.total, link.bytes);
    EXPECT_EQ(report.bytes.in_frames, link.bytes);
    EXPECT_EQ(report.bytes.skipped, 0U);
    EXPECT_EQ(report.bytes.buffered, 0U);
    EXPECT_EQ(report.frames.good, 156U);
    EXPECT_EQ(report.frames.corrupted, 0U);
    EXPECT_EQ(report.samples.good, 151U * 16U);
    EXPECT_TRUE(report.complete());
    EXPECT_TRUE(report.dropouts.empty());
    EXPECT_EQ(report.boots, 1U);
    EXPECT_EQ(report.runs, 1U);
}

TEST(LinkAccounts, AnySlicingOfAStreamGivesTheSameAccounts) {
    MadeBoard board;
    Bytes stream = board.hello_frame();
    for (const Bytes& part : {board.config_frame(), board.samples_frame(glp_flag_first_after_start),
                              board.samples_frame(), board.status_frame()}) {
        stream.insert(stream.end(), part.begin(), part.end());
    }
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
        StreamDecoder decoder;
        decoder.feed(ByteView(stream).first(cut), {});
        decoder.feed(ByteView(stream).subspan(cut), {});
        ASSERT_EQ(decoder.report().frames.good, 5U) << cut;
        ASSERT_EQ(decoder.report().bytes.in_frames, stream.size()) << cut;
    }
}

TEST(LinkAccounts, CountsFramesTheLinkDroppedAndBlamesTheLink) {
    Listening link;
    link.begin();
    link.hear_samples(10);
    for (int i = 0; i < 3; ++i) { static_cast<void>(link.board.samples_frame()); }
    link.hear_samples(10);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.frames.missing, 3U);
    EXPECT_EQ(report.samples.missing, 48U);
    EXPECT_EQ(report.samples.lost_on_device, 0U);
    ASSERT_EQ(report.dropouts.size(), 1U);
    EXPECT_EQ(report.dropouts[0].first_index, 11U * 16U);
    EXPECT_EQ(report.dropouts[0].samples, 48U);
    EXPECT_EQ(report.dropouts[0].cause, DropoutCause::link);
}

TEST(LinkAccounts, DropsADuplicateAndCountsIt) {
    Listening link;
    link.begin();
    const Bytes twice = link.board.samples_frame();
    link.hear(twice);
    link.hear(twice);
    link.hear_samples(1);
    link.hear(twice);
    link.hear_samples(1);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.frames.duplicated, 2U);
    EXPECT_EQ(report.frames.good, 6U);
    EXPECT_EQ(report.samples.good, 4U * 16U);
    EXPECT_TRUE(report.complete());
    EXPECT_EQ(report.boots, 1U);
}

TEST(LinkAccounts, CountsACorruptedFrameOnceAsCorruptedAndOnceAsMissing) {
    Listening link;
    link.begin();
    Bytes broken = link.board.samples_frame();
    broken[40] = static_cast<std::uint8_t>(broken[40] == 1 ? 2 : 1);
    link.hear(broken);
    link.hear_samples(3);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.frames.corrupted, 1U);
    EXPECT_EQ(report.frames.missing, 1U);
    EXPECT_EQ(report.samples.missing, 16U);
    EXPECT_GT(report.bytes.skipped, 0U);
    EXPECT_TRUE(report.bytes.balanced());
}

TEST(LinkAccounts, AMalformedMessageIsNoGoodFrameButNotMissing) {
    Listening link;
    link.begin();
    const std::uint8_t short_payload[3] = {1, 2, 3};
    link.hear(link.board.frame(glp_frame_samples, 0, short_payload));
    link.hear_samples(1);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.frames.corrupted, 1U);
    EXPECT_EQ(report.frames.corrupted_by_reason[glp_status_bad_length], 1U);
    EXPECT_EQ(report.frames.good, 4U);
    EXPECT_EQ(report.frames.missing, 0U);
}

TEST(LinkAccounts, NamesTheCauseTheBoardGives) {
    const std::pair<std::uint16_t, DropoutCause> cases[] = {
        {glp_flag_sensor_fifo_overflow, DropoutCause::sensor_fifo_overflow},
        {glp_flag_bus_error, DropoutCause::bus_error},
        {glp_flag_ring_overflow, DropoutCause::ring_overflow}};
    for (const auto& [flag, cause] : cases) {
        Listening link;
        link.begin();
        link.board.lose_samples(12);
        link.hear(link.board.samples_frame(flag));
        const LinkReport report = link.decoder.report();
        ASSERT_EQ(report.dropouts.size(), 1U);
        EXPECT_EQ(report.dropouts[0].samples, 12U);
        EXPECT_EQ(report.dropouts[0].cause, cause);
        EXPECT_EQ(report.samples.lost_on_device, 12U);
        EXPECT_EQ(report.frames.missing, 0U);
    }
}

TEST(LinkAccounts, SharesAGapBetweenBoardAndLink) {
    Listening link;
    link.begin();
    link.board.lose_samples(5);
    static_cast<void>(link.board.samples_frame(glp_flag_sensor_fifo_overflow));  // lost with its flag
    link.hear_samples(1);
    const LinkReport report = link.decoder.report();
    ASSERT_EQ(report.dropouts.size(), 2U);
    EXPECT_EQ(report.dropouts[0].samples, 5U);
    EXPECT_EQ(report.dropouts[0].cause, DropoutCause::device);
    EXPECT_EQ(report.dropouts[1].samples, 16U);
    EXPECT_EQ(report.dropouts[1].cause, DropoutCause::link);
    EXPECT_EQ(report.samples.missing, 21U);
}

TEST(LinkAccounts, AnEventNamesTheCauseWhenTheFlagWasLost) {
    Listening link;
    link.begin();
    link.board.lose_samples(5);
    static_cast<void>(link.board.samples_frame(glp_flag_bus_error));
    link.hear(link.board.event_frame(glp_event_bus_error));
    link.hear_samples(1);
    const LinkReport report = link.decoder.report();
    ASSERT_EQ(report.dropouts.size(), 2U);
    EXPECT_EQ(report.dropouts[0].cause, DropoutCause::bus_error);
}

TEST(LinkAccounts, FramesTheRingHadNoRoomForAreTheBoardsLoss) {
    Listening link;
    link.begin();
    link.hear(link.board.status_frame());
    for (int i = 0; i < 4; ++i) {
        static_cast<void>(link.board.samples_frame());
        link.board.lost_samples += 16;
        ++link.board.lost_frames;
    }
    link.hear(link.board.samples_frame(glp_flag_ring_overflow));
    link.hear(link.board.status_frame());
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.frames.missing, 4U);
    EXPECT_EQ(report.frames.lost_on_device, 4U);
    ASSERT_EQ(report.dropouts.size(), 1U);
    EXPECT_EQ(report.dropouts[0].samples, 64U);
    EXPECT_EQ(report.dropouts[0].cause, DropoutCause::ring_overflow);
}

TEST(LinkAccounts, NumbersMayGoRound) {
    Listening link;
    link.board.sequence = 0xFFFF'FFF0U;
    link.begin();
    link.hear_samples(40);
    static_cast<void>(link.board.samples_frame());
    link.hear_samples(1);
    EXPECT_EQ(link.decoder.report().frames.missing, 1U);
    EXPECT_EQ(link.decoder.report().boots, 1U);
}

// No number tells of it, and yet nothing was sampled while the board booted.
TEST(LinkAccounts, AResetIsNoGapInTheNumbersButAPauseInTime) {
    Listening link;
    link.begin();
    link.hear_samples(300);
    link.board.hello.boot_id = 0xB002;
    link.board.sequence = 0;
    link.board.restart(20.0);
    link.begin();
    link.hear_samples(10);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.frames.missing, 0U);
    EXPECT_EQ(report.frames.duplicated, 0U);
    EXPECT_EQ(report.boots, 2U);
    EXPECT_EQ(report.runs, 2U);
    ASSERT_EQ(report.dropouts.size(), 1U);
    EXPECT_EQ(report.dropouts[0].cause, DropoutCause::reset);
    EXPECT_NEAR(static_cast<double>(report.dropouts[0].samples), 20.0 * 1003.0 - 301 * 16, 1.0);
    EXPECT_EQ(report.samples.missing, report.samples_in_joins);
}

TEST(LinkAccounts, TakesNothingOfAResetBoardUntilItSaysWhoItIs) {
    Listening link;
    link.begin();
    link.hear_samples(5);
    link.board.sequence = 0;
    link.board.restart(20.0);
    link.board.hello.boot_id = 0xB002;
    static_cast<void>(link.board.hello_frame());
    link.hear(link.board.config_frame());
    link.hear(link.board.samples_frame(glp_flag_first_after_start));
    EXPECT_EQ(link.decoder.report().frames.duplicated, 2U);
    link.hear(link.board.hello_frame());
    link.hear_samples(2);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.boots, 2U);
    EXPECT_EQ(report.frames.missing, 0U);
    EXPECT_EQ(report.samples.missing - report.samples_in_joins, 16U);
    EXPECT_EQ(report.samples.good, 8U * 16U);
}

TEST(LinkAccounts, WhatTheBoardThrowsAwayAtAStartIsNotMissing) {
    Listening link;
    link.hear(link.board.event_frame(glp_event_text));
    link.board.sequence += 30;
    link.hear(link.board.hello_frame());
    EXPECT_EQ(link.decoder.report().frames.missing, 30U) << "nothing tells a start yet";
    link.hear(link.board.config_frame());
    link.hear(link.board.event_frame(glp_event_started));
    link.hear(link.board.samples_frame(glp_flag_first_after_start));
    EXPECT_EQ(link.decoder.report().frames.missing, 0U);
    EXPECT_EQ(link.decoder.report().frames.dropped_at_start, 30U);
    link.board.sequence += 4;
    link.hear(link.board.hello_frame());
    link.hear(link.board.config_frame());
    link.hear_samples(1);
    EXPECT_EQ(link.decoder.report().frames.missing, 4U) << "a HELLO in mid-stream excuses nothing";
}

TEST(LinkAccounts, AStartWhoseFirstFramesWereLostMissesExactlyThose) {
    Listening link;
    link.begin();
    link.hear_samples(5);
    link.hear(link.board.event_frame(glp_event_stopped));
    link.board.restart(1.0);
    static_cast<void>(link.board.samples_frame(glp_flag_first_after_start));
    static_cast<void>(link.board.samples_frame());
    link.hear_samples(2);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.frames.missing, 2U);
    EXPECT_EQ(report.samples.missing, 32U);
    EXPECT_EQ(report.runs, 2U);
}

TEST(LinkAccounts, AStopMissesNothingAndItsLengthIsKnown) {
    Listening link;
    link.begin();
    link.hear_samples(5);
    link.hear(link.board.event_frame(glp_event_stopped));
    link.board.restart(3.0);
    link.hear(link.board.samples_frame(glp_flag_first_after_start));
    link.hear_samples(5);
    const LinkReport report = link.decoder.report();
    EXPECT_TRUE(report.complete());
    EXPECT_EQ(report.samples.missing, 0U);
    EXPECT_TRUE(report.dropouts.empty());
    ASSERT_EQ(report.stops.size(), 1U);
    EXPECT_EQ(report.stops[0].cause, DropoutCause::stopped);
    EXPECT_NEAR(static_cast<double>(report.samples_in_stops), 3.0 * 1003.0 - 6 * 16, 1.0);
    EXPECT_EQ(report.instants(), report.samples.good + report.samples_in_stops);
    const std::vector<Dropout> timed = link.decoder.timed(report.stops);
    ASSERT_EQ(timed.size(), 1U);
    EXPECT_NEAR(timed[0].at_s, 6 * 16 / 1003.0, 1e-3);
}

TEST(LinkAccounts, JoiningARunningStreamMissesNothing) {
    Listening link;
    static_cast<void>(link.board.hello_frame());
    for (int i = 0; i < 500; ++i) { static_cast<void>(link.board.samples_frame()); }
    const Bytes cut = link.board.samples_frame();
    link.hear(Bytes(cut.begin() + 50, cut.end()));
    link.hear_samples(5);
    const LinkReport report = link.decoder.report();
    EXPECT_TRUE(report.complete());
    EXPECT_EQ(report.bytes_skipped_at_head, report.bytes.skipped);
    EXPECT_EQ(report.frames.corrupted, 0U);
    EXPECT_EQ(report.samples.good, 80U);
}

// SPEC.md, 9.5: what came before the host raised DTR is an earlier listener's.
TEST(LinkAccounts, WhatCameBeforeTheStartIsCountedApartAndNoSampleOfItTaken) {
    Listening link;
    link.begin();
    link.hear_samples(3);
    static_cast<void>(link.board.samples_frame());
    link.hear_samples(1);
    EXPECT_GT(link.decoder.report().samples.missing, 0U);
    const std::uint64_t before = link.decoder.report().frames.good;
    Transfer raised;
    raised.event = Transfer::Event::submission;
    raised.kind = TransferKind::control;
    raised.setup = {0x21, 0x22, 1, 0, 0, 0, 0, 0};
    EXPECT_TRUE(link.decoder.take(raised));
    link.board.restart(1.0);
    link.begin();
    link.hear_samples(1);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.bytes.total, link.bytes);
    EXPECT_EQ(report.frames_before_start, before);
    EXPECT_EQ(report.samples.good, 2U * 16U);
    EXPECT_EQ(report.samples.missing, 0U);
    EXPECT_TRUE(report.complete());
    const auto recording = link.decoder.take_recording("bench");
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(recording->rows(), 32U);
}

TEST(LinkAccounts, AStatusProvesWhatIsMissingAtTheEnd) {
    Listening link;
    link.begin();
    for (int i = 0; i < 4; ++i) { static_cast<void>(link.board.samples_frame()); }
    link.hear(link.board.status_frame());
    // Of the 64 instants, up to 15 could still wait in a frame that is not full, and 42 in the sensor's FIFO.
    EXPECT_EQ(link.decoder.report().samples.missing, 7U);
    link.hear(link.board.event_frame(glp_event_stopped));
    EXPECT_EQ(link.decoder.report().samples.missing, 64U);
}

TEST(LinkAccounts, AnImpossibleIndexBeginsAnewInsteadOfCountingLosses) {
    Listening link;
    link.begin();
    link.board.index = std::uint64_t{1} << 62U;
    link.board.rate_hz = 1e15;
    link.hear_samples(2);
    const LinkReport report = link.decoder.report();
    EXPECT_EQ(report.samples.missing, 0U);
    EXPECT_EQ(report.runs, 2U);
}

// What the writer's thread asks for after every batch holds no list, and is the report's own.
TEST(LinkAccounts, CountsAreTheReportsAndHoldNoList) {
    static_assert(std::is_trivially_copyable_v<LinkCounts>);
    Listening link;
    link.begin();
    for (std::uint32_t i = 0; i < 200; ++i) {
        if (i % 3 == 0) { link.board.lose_samples(5); }
        if (i % 20 == 19) {
            link.decoder.begin_connection();
            if (i % 40 == 19) { ++link.board.hello.boot_id; }
            link.board.restart(link.board.time_s() + 2.0);
            link.begin();
        }
        link.hear_samples(i % 7);
        link.hear(link.board.status_frame());
        const LinkReport report = link.decoder.report();
        const LinkCounts counts = link.decoder.counts();
        std::uint64_t missing = 0;
        for (const LinkDropout& dropout : report.dropouts) { missing += dropout.samples; }
        EXPECT_EQ(counts.samples.missing, missing) << i;
        EXPECT_EQ(counts.samples.missing, report.samples.missing) << i;
        EXPECT_EQ(counts.samples_in_joins, report.samples_in_joins) << i;
        EXPECT_EQ(counts.dropouts_counted, report.dropouts.size()) << i;
        EXPECT_TRUE(std::ranges::is_sorted(report.dropouts, {}, &LinkDropout::run)) << i;
    }
    EXPECT_EQ(link.decoder.report().joins.size(), 10U);
}

// A board that is reset, or says so, all the time.
TEST(LinkAccounts, AJoinIsWorkedOutOnce) {
    Listening link;
    link.begin();
    std::size_t most = 0;
    for (int i = 0; i < 3000; ++i) {
        ++link.board.hello.boot_id;
        link.board.restart(link.board.time_s() + 0.5);
        link.begin();
        most = std::max(most, link.decoder.open_joins());
    }
    EXPECT_EQ(link.decoder.report().joins.size(), 3000U);
    EXPECT_GT(link.decoder.report().samples_in_joins, 0U);
    EXPECT_LE(most, 2U);
}

}  // namespace
}  // namespace gyrolog
