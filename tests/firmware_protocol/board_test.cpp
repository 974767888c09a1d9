#include <memory>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench_board.hpp"

namespace gyrolog {
namespace {

std::uint64_t samples_in(const std::vector<ReceivedFrame>& frames) {
    return std::accumulate(frames.begin(), frames.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const ReceivedFrame& frame) {
                               return sum + (frame.type == glp_frame_samples ? frame.samples().count : 0U);
                           });
}

// The promise of SPEC.md 5.3: indices ascend, and a jump is what lost_samples grew by. Returns the next
// index.
std::uint64_t expect_accounted(const std::vector<ReceivedFrame>& frames) {
    std::uint64_t delivered = 0;
    std::uint64_t next_index = 0;
    for (const ReceivedFrame& frame : frames) {
        if (frame.type != glp_frame_samples) { continue; }
        const glp_samples samples = frame.samples();
        EXPECT_GE(samples.first_index, next_index);
        EXPECT_EQ(delivered + samples.lost_samples, samples.first_index);
        delivered += samples.count;
        next_index = samples.first_index + samples.count;
    }
    return next_index;
}

std::vector<std::uint8_t> types_of(const std::vector<ReceivedFrame>& frames) {
    std::vector<std::uint8_t> types;
    types.reserve(frames.size());
    for (const ReceivedFrame& frame : frames) { types.push_back(frame.type); }
    return types;
}

glp_config config_of(const ReceivedFrame& received) {
    glp_config config{};
    const glp_frame frame = received.view();
    EXPECT_EQ(glp_config_read(&frame, &config), glp_status_ok);
    return config;
}

std::uint8_t result_of(const ReceivedFrame& received) {
    glp_reply reply{};
    const glp_frame frame = received.view();
    EXPECT_EQ(received.type, glp_frame_reply);
    EXPECT_EQ(glp_reply_read(&frame, &reply), glp_status_ok);
    return reply.result;
}

TEST(Board, RisingDtrIntroducesTheBoardAndThenStreams) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(8);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(types_of(frames), (std::vector<std::uint8_t>{glp_frame_hello, glp_frame_config, glp_frame_event,
                                                           glp_frame_samples, glp_frame_samples}));
    glp_hello hello{};
    const glp_frame first = frames[0].view();
    ASSERT_EQ(glp_hello_read(&first, &hello), glp_status_ok);
    EXPECT_EQ(hello.who_am_i, 0x71);
    EXPECT_STREQ(hello.firmware, "bench");
    EXPECT_STREQ(hello.sensor, "MPU-9250");
    EXPECT_EQ(hello.boot_id, 77U);
    const glp_config config = config_of(frames[1]);
    EXPECT_EQ(config.rate_mHz, 100'000U);
    EXPECT_EQ(config.samples_per_frame, 4);
    EXPECT_EQ(config.decimation, 1);
    EXPECT_EQ(frames[2].event().code, glp_event_started);
    EXPECT_EQ(frames[3].flags, glp_flag_first_after_start);
    EXPECT_EQ(frames[4].flags, 0);
}

TEST(Board, EachSampleHasItsFieldsInOrderItsIndexAndItsInterruptsTick) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    const std::uint64_t first_tick = bench.ticks + bench.sample_period_us;
    bench.run(400);
    std::uint64_t index = 0;
    for (const ReceivedFrame& frame : bench.take_frames(glp_frame_samples)) {
        const glp_samples samples = frame.samples();
        ASSERT_EQ(samples.count, 4);
        EXPECT_EQ(samples.first_index, index);
        EXPECT_EQ(samples.first_ticks, first_tick + index * bench.sample_period_us);
        EXPECT_EQ(samples.temperature, 0x0102);
        for (std::size_t i = 0; i < samples.count; ++i, ++index) {
            EXPECT_EQ(glp_sample_field(&samples, i, 0), static_cast<std::int16_t>(index));
            EXPECT_EQ(glp_sample_field(&samples, i, 2), 0x0003);
            EXPECT_EQ(glp_sample_field(&samples, i, 3), 0x1111);
            EXPECT_EQ(glp_sample_field(&samples, i, 5), 0x3333);
        }
    }
    EXPECT_EQ(index, 400U);
}

TEST(Board, FallingDtrSendsThePartialFrameAndThenIsSilent) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(6);
    glp_board_on_line_state(&bench.board, false);
    glp_board_poll(&bench.board);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(samples_in(frames), 6U);
    EXPECT_EQ(frames.back().event().code, glp_event_stopped);
    bench.run(1000);
    EXPECT_TRUE(bench.wire.empty());
    EXPECT_EQ(bench.sensor.registers[glp_mpu_int_enable], 0);
}

TEST(Board, RaisingDtrAgainStartsFromACleanState) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.endpoint_room = 0;
    bench.run(200);  // the host has stopped reading; the ring fills
    glp_board_on_line_state(&bench.board, false);
    glp_board_on_line_state(&bench.board, true);
    bench.wire.clear();
    bench.endpoint_room = SIZE_MAX;
    bench.run(4);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(bench.stream().rejected[glp_status_bad_crc] + bench.stream().rejected[glp_status_bad_cobs], 0U);
    EXPECT_EQ(types_of(frames), (std::vector<std::uint8_t>{glp_frame_hello, glp_frame_config, glp_frame_event,
                                                           glp_frame_samples}));
    EXPECT_EQ(frames.back().samples().first_index, 0U);
    EXPECT_EQ(frames.back().samples().lost_samples, 0U);
    EXPECT_EQ(frames.back().flags, glp_flag_first_after_start);
}

TEST(Board, AFrameWhoseSendingHasBegunIsFinishedAcrossADtrEdge) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.take_frames();
    bench.endpoint_room = 10;
    bench.run(40);
    ASSERT_EQ(bench.wire.size(), 10U);
    glp_board_on_line_state(&bench.board, false);
    glp_board_on_line_state(&bench.board, true);
    bench.endpoint_room = SIZE_MAX;
    glp_board_poll(&bench.board);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(types_of(frames), (std::vector<std::uint8_t>{glp_frame_samples, glp_frame_hello,
                                                           glp_frame_config, glp_frame_event}));
    EXPECT_EQ(bench.stream().bytes_skipped, 0U);
}

TEST(Board, AnEndpointThatTakesSevenBytesAtATimeTearsNoFrame) {
    BenchBoard bench;
    bench.endpoint_piece = 7;
    bench.boot_and_raise_dtr();
    bench.run(2000);
    EXPECT_GT(bench.board.lost_frames, 0U);  // 7 bytes a turn are less than the stream needs
    glp_board_on_line_state(&bench.board, false);
    for (int i = 0; i < 1000; ++i) { glp_board_poll(&bench.board); }
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(bench.stream().bytes_skipped, 0U);
    expect_accounted(frames);
    EXPECT_EQ(samples_in(frames) + bench.board.lost_samples, 2000U);
}

TEST(Board, AFullRingDropsWholeFramesCountsThemAndSaysSoLater) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    std::vector<ReceivedFrame> frames = bench.take_frames();
    bench.endpoint_room = 0;
    bench.run(1000);  // 10 s at 100 Hz: 250 frames of about 90 bytes into 4 KiB
    const std::uint32_t dropped = bench.board.lost_frames;
    EXPECT_GT(dropped, 150U);
    bench.endpoint_room = SIZE_MAX;
    bench.run(100);
    const std::vector<ReceivedFrame> later = bench.take_frames();
    frames.insert(frames.end(), later.begin(), later.end());

    EXPECT_EQ(bench.stream().bytes_skipped, 0U);
    EXPECT_EQ(expect_accounted(frames), 1100U);
    EXPECT_EQ(samples_in(frames) + bench.board.lost_samples, 1100U);
    const std::uint32_t numbers_used = frames.back().sequence - frames.front().sequence + 1U;
    EXPECT_EQ(numbers_used - frames.size(), dropped);
    std::uint64_t told = 0;
    int flagged = 0;
    for (const ReceivedFrame& frame : frames) {
        if (frame.type == glp_frame_event && frame.event().code == glp_event_ring_overflow) {
            told += static_cast<std::uint64_t>(frame.event().value);
        }
        if (frame.type == glp_frame_samples && (frame.flags & glp_flag_ring_overflow) != 0) { ++flagged; }
    }
    EXPECT_EQ(told, dropped);
    EXPECT_GE(flagged, 1);
}

TEST(Board, AFullRingStillLetsAReplyThrough) {
    // Every size over more than a frame, so that in one of them the frames fill the ring to its last byte.
    for (std::size_t ring_bytes = GLP_BOARD_RING_MIN; ring_bytes < GLP_BOARD_RING_MIN + 100; ++ring_bytes) {
        BenchBoard bench(ring_bytes);
        bench.boot_and_raise_dtr();
        bench.endpoint_room = 0;
        bench.run(96);  // 24 frames, and no STATUS yet
        ASSERT_GT(bench.board.lost_frames, 0U);
        bench.command(glp_frame_get_hello);
        bench.endpoint_room = SIZE_MAX;
        glp_board_poll(&bench.board);
        EXPECT_EQ(bench.take_frames(glp_frame_reply).size(), 1U) << ring_bytes;
    }
}

TEST(Board, TheTailOfAFrameNeverWaitsForTheNextOne) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    const int flushes = bench.flushes;
    bench.run(4);
    EXPECT_EQ(bench.flushes, flushes + 1);
    bench.run(3);
    EXPECT_EQ(bench.flushes, flushes + 1);
}

TEST(Board, NoSampleWaitsLongerThanTheHundredMillisecondsOfItsPatience) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    glp_configure wanted{};
    wanted.samples_per_frame = 80;  // 0.8 s at 100 Hz
    bench.configure(wanted);
    bench.run(1000);
    for (const ReceivedFrame& frame : bench.take_frames(glp_frame_samples)) {
        EXPECT_LE(frame.samples().count, 11);
    }
    EXPECT_LE(bench.board.frame_samples, 11);
    EXPECT_EQ(bench.board.lost_samples, 0U);
}

TEST(Board, AFifoOverflowCostsACountedNumberOfSamplesAndLeavesTheRestAligned) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(20);
    bench.run(50, false);  // 43 samples of 12 bytes are more than 512
    bench.run(200);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(expect_accounted(frames) + bench.samples_under_way(), 270U);
    EXPECT_EQ(bench.board.fifo_overflows, 1U);
    EXPECT_EQ(bench.board.lost_samples, 51U);  // those in the FIFO and the one that came with the next turn
    bool flagged = false;
    bool told = false;
    for (const ReceivedFrame& frame : frames) {
        if (frame.type == glp_frame_event && frame.event().code == glp_event_sensor_fifo_overflow) {
            told = frame.event().value == 51 && frame.event().index == 20;
        }
        if (frame.type != glp_frame_samples) { continue; }
        const glp_samples samples = frame.samples();
        flagged = flagged || (frame.flags & glp_flag_sensor_fifo_overflow) != 0;
        EXPECT_EQ(glp_sample_field(&samples, 0, 0), static_cast<std::int16_t>(samples.first_index));
        EXPECT_EQ(glp_sample_field(&samples, 0, 3), 0x1111);
    }
    EXPECT_TRUE(flagged);
    EXPECT_TRUE(told);
}

TEST(Board, AFailedFifoReadIsABusErrorThatCostsWhatTheFifoHeld) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(8);
    bench.sensor.fifo_reads_to_fail = 1;
    bench.run(40);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(bench.board.bus_errors, 1U);
    EXPECT_EQ(bench.board.lost_samples, 4U);
    EXPECT_EQ(expect_accounted(frames), 48U);
    const auto after = std::find_if(frames.begin(), frames.end(), [](const ReceivedFrame& frame) {
        return frame.type == glp_frame_samples && frame.samples().first_index == 12;
    });
    ASSERT_NE(after, frames.end());
    EXPECT_EQ(after->flags, glp_flag_bus_error);
}

TEST(Board, TheFirstFrameAfterAStartIsMarkedEvenWhenWhatCameBeforeItWasLost) {
    BenchBoard failing_bus;
    failing_bus.boot_and_raise_dtr();
    failing_bus.sensor.fifo_reads_to_fail = 1;
    failing_bus.run(12);
    const std::vector<ReceivedFrame> after_error = failing_bus.take_frames(glp_frame_samples);
    EXPECT_EQ(after_error.front().flags, glp_flag_first_after_start | glp_flag_bus_error);

    BenchBoard full_ring;
    full_ring.endpoint_room = 0;
    full_ring.boot_and_raise_dtr();
    full_ring.board.ring.used = full_ring.board.ring.capacity;  // no room for a first frame
    full_ring.run(4);
    full_ring.board.ring.used = 0;
    full_ring.endpoint_room = SIZE_MAX;
    full_ring.run(4);
    const std::vector<ReceivedFrame> after_drop = full_ring.take_frames(glp_frame_samples);
    EXPECT_EQ(after_drop.front().samples().first_index, 4U);
    EXPECT_EQ(after_drop.front().flags, glp_flag_first_after_start | glp_flag_ring_overflow);
}

TEST(Board, ABusThatIsDeadForASecondCostsThatSecondAndNoMore) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(20);
    bench.sensor.bus_broken = true;
    bench.run(100);
    bench.sensor.bus_broken = false;
    bench.run(100);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(expect_accounted(frames) + bench.samples_under_way(), 220U);
    EXPECT_GE(bench.board.lost_samples, 100U);
    EXPECT_LE(bench.board.lost_samples, 101U);
}

TEST(Board, AMissedInterruptIsFoundFromTheFifosCount) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(8);
    bench.sensor.sample();  // its interrupt goes unseen
    bench.ticks += bench.sample_period_us;
    bench.run(100);
    const std::vector<ReceivedFrame> frames = bench.take_frames(glp_frame_samples);
    EXPECT_EQ(expect_accounted(frames) + bench.samples_under_way(), 109U);
    const glp_samples last = frames.back().samples();
    EXPECT_EQ(glp_sample_field(&last, 0, 0), static_cast<std::int16_t>(last.first_index));
}

// The instants that the events of this code tell as lost.
std::uint64_t told_lost(const std::vector<ReceivedFrame>& frames, glp_event_code code) {
    std::uint64_t lost = 0;
    for (const ReceivedFrame& frame : frames) {
        if (frame.type == glp_frame_event && frame.event().code == code) {
            lost += static_cast<std::uint64_t>(frame.event().value);
        }
    }
    return lost;
}

TEST(Board, AnInterruptThatStaysAwayIsToldAndCostsACountedNumberOfSamples) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(100);
    std::vector<ReceivedFrame> frames = bench.take_frames();
    bench.sensor.int_line_broken = true;
    bench.run(36);  // 0.36 s: longer than the limit of 0.25 s and the 0.1 s between two EVENTs
    const std::vector<ReceivedFrame> soon = bench.take_frames();
    EXPECT_GT(told_lost(soon, glp_event_data_ready_silent), 20U);
    bench.run(264);
    bench.sensor.int_line_broken = false;
    bench.run(100);
    const std::vector<ReceivedFrame> later = bench.take_frames();
    frames.insert(frames.end(), soon.begin(), soon.end());
    frames.insert(frames.end(), later.begin(), later.end());
    EXPECT_EQ(expect_accounted(frames) + bench.samples_under_way(), 500U);
    EXPECT_EQ(samples_in(frames) + bench.samples_under_way() + bench.board.lost_samples, 500U);
    EXPECT_GE(bench.board.lost_samples, 300U);
    EXPECT_LE(bench.board.lost_samples, 342U);  // and what the FIFO held at the first interrupt
    EXPECT_EQ(told_lost(frames, glp_event_data_ready_silent) + told_lost(frames, glp_event_text),
              bench.board.lost_samples);
    EXPECT_EQ(told_lost(frames, glp_event_sensor_fault), 0U);
    std::uint16_t flags = 0;
    for (const ReceivedFrame& frame : later) {
        if (frame.type == glp_frame_samples) { flags |= frame.flags; }
    }
    EXPECT_NE(flags & glp_flag_data_ready_silent, 0);
}

TEST(Board, StoppedInASilenceItHasCountedToTheStop) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(100);
    bench.sensor.int_line_broken = true;
    bench.run(110);
    glp_board_on_line_state(&bench.board, false);
    glp_board_poll(&bench.board);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(frames.back().event().code, glp_event_stopped);
    EXPECT_EQ(frames.back().event().index, 210U);
    EXPECT_EQ(frames.back().event().value, 110);
}

TEST(Board, ASensorThatForgotItsSetUpIsSetUpAgainWhileItStreams) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    const std::uint8_t gyro_config = bench.sensor.registers[glp_mpu_gyro_config];
    ASSERT_NE(gyro_config, 0);
    bench.run(100);
    bench.sensor.reset();
    const std::uint64_t ticks_before = bench.ticks;
    bench.run(200);
    const std::uint64_t passed =
        (bench.ticks - ticks_before) / bench.sample_period_us;  // its reset takes time
    EXPECT_EQ(bench.sensor.registers[glp_mpu_gyro_config], gyro_config);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_NEAR(static_cast<double>(expect_accounted(frames) + bench.samples_under_way()),
                static_cast<double>(100 + passed), 1.0);
    EXPECT_LT(bench.board.lost_samples, 100U);
    EXPECT_EQ(frames.back().samples().count, 4);
    int faults = 0;
    for (const ReceivedFrame& frame : frames) {
        if (frame.type != glp_frame_event || frame.event().code != glp_event_sensor_fault) { continue; }
        ++faults;
        EXPECT_EQ(frame.event().value & 0xFF, 0) << "what the register held";
    }
    EXPECT_EQ(faults, 1);
}

TEST(Board, AStartFindsASensorThatForgotItsSetUpSinceTheLast) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(10);
    const std::uint8_t gyro_config = bench.sensor.registers[glp_mpu_gyro_config];
    glp_board_on_line_state(&bench.board, false);
    glp_board_poll(&bench.board);
    bench.take_frames();
    bench.sensor.reset();
    glp_board_on_line_state(&bench.board, true);
    glp_board_poll(&bench.board);
    bench.run(8);
    EXPECT_EQ(bench.sensor.registers[glp_mpu_gyro_config], gyro_config);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(types_of(frames),
              (std::vector<std::uint8_t>{glp_frame_hello, glp_frame_config, glp_frame_event, glp_frame_event,
                                         glp_frame_samples, glp_frame_samples}));
    EXPECT_EQ(config_of(frames[1]).registers[2], gyro_config);
    const std::vector<std::uint16_t> codes{frames[2].event().code, frames[3].event().code};
    EXPECT_THAT(codes, testing::UnorderedElementsAre(glp_event_started, glp_event_sensor_fault));
}

TEST(Board, AJumpInTheInstantsEndsTheFrameAndFlagsTheNext) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(6);
    bench.ticks += 7ULL * bench.sample_period_us;
    bench.run(10);
    const std::vector<ReceivedFrame> frames = bench.take_frames(glp_frame_samples);
    ASSERT_GE(frames.size(), 3U);
    EXPECT_EQ(frames[1].samples().count, 2);
    EXPECT_EQ(frames[2].samples().first_index, 6U);
    EXPECT_EQ(frames[2].flags, glp_flag_time_discontinuity);
    EXPECT_EQ(bench.board.lost_samples, 0U);
}

TEST(Board, TicksThatWrapAtThirtyTwoBitsChangeNothingButThemselves) {
    BenchBoard bench(4096, 32);
    bench.ticks = 0xFFFFFFFFULL - 2'000'000;
    bench.boot_and_raise_dtr();
    bench.run(1000);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(expect_accounted(frames), 1000U);
    int statuses = 0;
    for (const ReceivedFrame& frame : frames) {
        if (frame.type == glp_frame_status) { ++statuses; }
        if (frame.type == glp_frame_samples) {
            EXPECT_LE(frame.samples().first_ticks, 0xFFFFFFFFULL);
            EXPECT_EQ(frame.flags & glp_flag_time_discontinuity, 0);
        }
    }
    EXPECT_EQ(statuses, 10);
}

TEST(Board, SequenceNumbersWrapWithoutAGap) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.take_frames();
    bench.board.sequence = 0xFFFFFFFEU;
    bench.run(16);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    ASSERT_EQ(frames.size(), 4U);
    EXPECT_EQ(frames[1].sequence, 0xFFFFFFFFU);
    EXPECT_EQ(frames[2].sequence, 0U);
}

TEST(Board, RepeatsItsIntroductionEveryFiveSecondsAndItsStatusEverySecond) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.take_frames();
    bench.run(3000);
    int hellos = 0;
    int configs = 0;
    int statuses = 0;
    for (const ReceivedFrame& frame : bench.take_frames()) {
        hellos += frame.type == glp_frame_hello;
        configs += frame.type == glp_frame_config;
        statuses += frame.type == glp_frame_status;
    }
    EXPECT_EQ(hellos, 6);
    EXPECT_EQ(configs, 6);
    EXPECT_EQ(statuses, 30);
}

TEST(Board, StartAndStopServeALineWithoutDtr) {
    BenchBoard bench;
    glp_board_boot(&bench.board);
    bench.command(glp_frame_start);
    bench.run(6);
    bench.command(glp_frame_stop);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(result_of(frames[0]), glp_result_ok);
    EXPECT_EQ(samples_in(frames), 6U);
    EXPECT_EQ(result_of(frames.back()), glp_result_ok);
    bench.run(100);
    EXPECT_TRUE(bench.wire.empty());
}

TEST(Board, RepeatedStartAndStopChangeNothing) {
    BenchBoard bench;
    glp_board_boot(&bench.board);
    bench.command(glp_frame_stop);
    bench.command(glp_frame_start);
    bench.run(6);
    bench.command(glp_frame_start);
    bench.run(2);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(expect_accounted(frames), 8U);
}

// SPEC.md, 9.6: a host whose REPLY was lost says it once more.
TEST(Board, EveryCommandMayBeRepeatedButAConfigureBeginsAnotherGeneration) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(4);
    bench.take_frames();
    for (const glp_frame_type type : {glp_frame_get_hello, glp_frame_start, glp_frame_get_status}) {
        for (int time = 0; time < 2; ++time) {
            bench.command(type);
            EXPECT_EQ(result_of(bench.take_frames().front()), glp_result_ok);
        }
    }
    bench.run(4);
    EXPECT_EQ(bench.take_frames().back().samples().first_index, 4U) << "the stream went on";
    glp_configure wanted{};
    wanted.rate_mHz = 200'000;
    for (std::uint16_t time = 1; time <= 2; ++time) {
        bench.configure(wanted);
        const std::vector<ReceivedFrame> frames = bench.take_frames();
        const auto config = std::ranges::find(frames, glp_frame_config, &ReceivedFrame::type);
        ASSERT_NE(config, frames.end());
        EXPECT_EQ(config_of(*config).generation, time);
        EXPECT_EQ(config_of(*config).rate_mHz, 200'000U);
    }
    for (int time = 0; time < 2; ++time) { bench.command(glp_frame_stop); }
    bench.take_frames();
    bench.run(4);
    EXPECT_TRUE(bench.take_frames().empty());
}

TEST(Board, ConfigureWhileStreamingRestartsUnderTheNextGeneration) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(6);
    bench.take_frames();
    glp_configure wanted{};
    wanted.rate_mHz = 1'000'000;
    wanted.gyro_full_scale_dps = 2000;
    wanted.layout = glp_layout_gyro;
    bench.configure(wanted);
    bench.sample_period_us = 1000;
    bench.run(40);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(types_of(frames),
              (std::vector<std::uint8_t>{glp_frame_samples, glp_frame_event, glp_frame_reply,
                                         glp_frame_config, glp_frame_event, glp_frame_samples}));
    const glp_config config = config_of(frames[3]);
    EXPECT_EQ(config.generation, 1);
    EXPECT_EQ(config.gyro_full_scale_dps, 2000);
    EXPECT_EQ(config.accel_full_scale_g, 8);
    EXPECT_EQ(config.dlpf_hz, 41);
    EXPECT_EQ(config.registers[0], 0);     // SMPLRT_DIV: 1 kHz undivided
    EXPECT_EQ(config.registers[2], 0x18);  // GYRO_CONFIG: 2000 dps
    EXPECT_EQ(config.registers[5], 0x70);  // FIFO_EN: gyro alone
    const glp_samples samples = frames.back().samples();
    EXPECT_EQ(samples.config_generation, 1);
    EXPECT_EQ(samples.first_index, 0U);
    EXPECT_EQ(samples.count, 40);
    EXPECT_EQ(frames.back().flags, glp_flag_first_after_start);
}

struct RefusedConfigure {
    const char* why;
    glp_configure asked;
};

TEST(Board, ConfigureRefusesWhatTheSensorDoesNotHaveAndStreamsOn) {
    const RefusedConfigure cases[] = {
        {"300 Hz is no divisor of 1 kHz", {300'000, 0, 0, 0, 0, 0}},
        {"3 Hz needs a divider above 256", {3'000, 0, 0, 0, 0, 0}},
        {"2 kHz is too fast for the 41 Hz filter", {2'000'000, 0, 0, 0, 0, 0}},
        {"no 300 dps range", {0, 300, 0, 0, 0, 0}},
        {"no 3 g range", {0, 0, 3, 0, 0, 0}},
        {"no 100 Hz filter", {0, 0, 0, 100, 0, 0}},
        {"82 samples of 12 bytes do not fit a frame", {0, 0, 0, 0, 0, 82}},
    };
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(4);
    bench.take_frames();
    for (const RefusedConfigure& refused : cases) {
        bench.configure(refused.asked);
        const std::vector<ReceivedFrame> frames = bench.take_frames();
        ASSERT_EQ(frames.size(), 1U) << refused.why;
        EXPECT_EQ(result_of(frames[0]), glp_result_bad_value) << refused.why;
    }
    bench.run(4);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    EXPECT_EQ(frames.back().samples().first_index, 4U);
    EXPECT_EQ(frames.back().samples().config_generation, 0);
}

TEST(Board, AnswersUnknownAndMalformedCommandsAndIgnoresEchoes) {
    BenchBoard bench;
    glp_board_boot(&bench.board);
    bench.command(0xF0);
    bench.command(glp_frame_configure, {1, 2, 3});
    bench.command(glp_frame_configure, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0, 0, 0, 0, 0});
    bench.command(glp_frame_samples, {1, 2, 3});
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    ASSERT_EQ(frames.size(), 3U);
    EXPECT_EQ(result_of(frames[0]), glp_result_unknown_command);
    EXPECT_EQ(result_of(frames[1]), glp_result_bad_length);
    EXPECT_EQ(result_of(frames[2]), glp_result_bad_value);
}

TEST(Board, ARateAboveThePortsLimitIsRefused) {
    BenchBoard bench;
    glp_board_boot(&bench.board);
    bench.board.identity.rate_max_mHz = 500'000;
    glp_configure wanted{};
    wanted.rate_mHz = 1'000'000;
    bench.configure(wanted);
    EXPECT_EQ(result_of(bench.take_frames().front()), glp_result_bad_value);
    wanted.rate_mHz = 500'000;
    bench.configure(wanted);
    EXPECT_EQ(result_of(bench.take_frames().front()), glp_result_ok);
}

TEST(Board, AWrongIdentityIsToldAfterHelloAndTheBoardStillAnswers) {
    BenchBoard bench;
    bench.sensor.who_am_i = 0x68;
    EXPECT_FALSE(glp_board_boot(&bench.board));
    glp_board_on_line_state(&bench.board, true);
    glp_board_poll(&bench.board);
    const std::vector<ReceivedFrame> frames = bench.take_frames();
    ASSERT_EQ(types_of(frames),
              (std::vector<std::uint8_t>{glp_frame_hello, glp_frame_config, glp_frame_event}));
    EXPECT_EQ(frames[2].event().code, glp_event_sensor_fault);
    EXPECT_EQ(frames[2].event().value, 0x7568);
    bench.command(glp_frame_start);
    EXPECT_EQ(result_of(bench.take_frames().front()), glp_result_sensor_fault);
    bench.sensor.who_am_i = GLP_MPU_9250_ID;
    bench.command(glp_frame_start);
    EXPECT_EQ(result_of(bench.take_frames().front()), glp_result_ok);
}

TEST(Board, SensorsWithTheSameRegistersAreTakenAndNamed) {
    const std::pair<unsigned, const char*> sensors[] = {
        {0x71, "MPU-9250"}, {0x73, "MPU-9255"}, {0x75, "MPU-9250 (75)"}};
    for (const auto& [who_am_i, name] : sensors) {
        SCOPED_TRACE(name);
        BenchBoard bench;
        bench.sensor.who_am_i = static_cast<std::uint8_t>(who_am_i);
        EXPECT_TRUE(glp_board_boot(&bench.board));
        glp_board_on_line_state(&bench.board, true);
        bench.run(8);
        const std::vector<ReceivedFrame> frames = bench.take_frames();
        ASSERT_EQ(types_of(frames),
                  (std::vector<std::uint8_t>{glp_frame_hello, glp_frame_config, glp_frame_event,
                                             glp_frame_samples, glp_frame_samples}));
        glp_hello hello{};
        const glp_frame first = frames[0].view();
        ASSERT_EQ(glp_hello_read(&first, &hello), glp_status_ok);
        EXPECT_EQ(hello.who_am_i, who_am_i);
        EXPECT_STREQ(hello.sensor, name);
        EXPECT_EQ(frames[2].event().code, glp_event_started);
    }
    // The neighbours: MPU-6500, MPU-6515, and none at all.
    for (const unsigned who_am_i : {0x70U, 0x72U, 0x74U, 0x76U, 0x68U, 0x00U, 0xFFU}) {
        EXPECT_EQ(glp_mpu_name(static_cast<std::uint8_t>(who_am_i)), nullptr) << who_am_i;
    }
}

TEST(Board, ARegisterThatReadsBackWrongIsASensorFault) {
    BenchBoard bench;
    bench.sensor.stuck_bits[glp_mpu_gyro_config] = 0x80;
    EXPECT_FALSE(glp_board_boot(&bench.board));
    glp_board_poll(&bench.board);
    EXPECT_TRUE(bench.wire.empty());  // nobody has asked yet
    glp_board_on_line_state(&bench.board, true);
    glp_board_poll(&bench.board);
    const std::vector<ReceivedFrame> frames = bench.take_frames(glp_frame_event);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].event().code, glp_event_sensor_fault);
    EXPECT_EQ(frames[0].event().value, (glp_mpu_gyro_config << 8) | 0x88);
}

TEST(Board, WithTheFilterBypassedEachKthSampleIsTakenFromTheRegisters) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    glp_configure wanted{};
    wanted.dlpf_hz = GLP_DLPF_OFF;
    wanted.rate_mHz = 8'000'000;  // each fourth of 32 kHz
    wanted.layout = glp_layout_gyro | glp_layout_accel | glp_layout_temperature;
    bench.configure(wanted);
    bench.take_frames();
    bench.sample_period_us = 31;
    const std::uint32_t first = bench.sensor.next;
    bench.run(4000);
    std::uint64_t index = 0;
    for (const ReceivedFrame& frame : bench.take_frames(glp_frame_samples)) {
        const glp_samples samples = frame.samples();
        for (std::size_t i = 0; i < samples.count; ++i, ++index) {
            EXPECT_EQ(glp_sample_field(&samples, i, 0), static_cast<std::int16_t>(first + 4 * index));
            EXPECT_EQ(glp_sample_field(&samples, i, 3), 0x1111);
            EXPECT_EQ(glp_sample_field(&samples, i, 6), 0x0102);
        }
    }
    EXPECT_EQ(index + bench.board.frame_samples, 1000U);
    EXPECT_EQ(bench.board.config.decimation, 4);
    EXPECT_EQ(bench.board.lost_samples, 0U);
}

TEST(Board, ARegisterReadThatComesTooLateIsALostSampleNotAWrongTime) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    glp_configure wanted{};
    wanted.dlpf_hz = 250;  // 100 Hz out of 8 kHz
    bench.configure(wanted);
    bench.take_frames();
    bench.sample_period_us = 125;
    bench.run(80 * 4);
    bench.read_delay_us = 3000;  // a quarter of the 10 ms period is 2500
    bench.run(80);
    bench.read_delay_us = 0;
    bench.run(80 * 8);
    EXPECT_EQ(bench.board.lost_samples, 1U);
    EXPECT_EQ(expect_accounted(bench.take_frames()) + bench.samples_under_way(), 13U);
}

TEST(Board, ASaturatedCountFlagsItsFrame) {
    BenchBoard bench;
    bench.boot_and_raise_dtr();
    bench.run(4);
    bench.sensor.gyro_z = 0x8000;
    bench.run(4);
    bench.sensor.gyro_z = 0x8001;
    bench.run(4);
    const std::vector<ReceivedFrame> frames = bench.take_frames(glp_frame_samples);
    ASSERT_EQ(frames.size(), 3U);
    EXPECT_EQ(frames[0].flags, glp_flag_first_after_start);
    EXPECT_EQ(frames[1].flags, glp_flag_saturated);
    EXPECT_EQ(frames[2].flags, 0);
}

TEST(Board, EveryKilohertzRateOfTheSensorStreamsWithoutLoss) {
    for (std::uint32_t divider = 1; divider <= 256; divider += 17) {
        BenchBoard bench;
        bench.boot_and_raise_dtr();
        glp_configure wanted{};
        wanted.rate_mHz = (1'000'000 + divider / 2) / divider;
        bench.configure(wanted);
        bench.take_frames();
        bench.sample_period_us = 1000 * divider;
        bench.run(500);
        EXPECT_EQ(bench.board.config.registers[0], divider - 1);
        EXPECT_EQ(samples_in(bench.take_frames()) + bench.samples_under_way(), 500U) << divider;
        EXPECT_EQ(bench.board.lost_samples, 0U) << divider;
    }
}

TEST(Board, RefusesATimerTooNarrowForItsPeriodsAndARingTooSmallForAFrame) {
    EXPECT_TRUE(BenchBoard(GLP_BOARD_RING_MIN, 32).initialised);
    EXPECT_FALSE(BenchBoard(GLP_BOARD_RING_MIN - 1, 32).initialised);
    EXPECT_FALSE(BenchBoard(4096, 31).initialised);
    EXPECT_FALSE(BenchBoard(4096, 65).initialised);
}

}  // namespace
}  // namespace gyrolog
