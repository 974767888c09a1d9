#include "host/virtual_board/virtual_board.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/simulate/converter.hpp"
#include "tests/host/virtual_board/board_stream.hpp"

namespace gyrolog {
namespace {

constexpr std::int64_t ms = 1'000'000;

std::unique_ptr<VirtualBoard> board_with(VirtualBoardOptions options) {
    auto board = VirtualBoard::create(std::move(options));
    EXPECT_TRUE(board.ok()) << (board.ok() ? "" : board.error().message);
    return std::move(board).value();
}

void drain(VirtualBoard& board, BoardStream& stream) {
    Bytes buffer(4096);
    while (const std::size_t size = board.in_endpoint().take_bytes(buffer)) {
        stream.feed(ByteView(buffer).first(size));
    }
}

// Streams so many samples, emptying the endpoint every 10 ms, and stops.
BoardStream stream_samples(VirtualBoard& board, std::uint64_t samples) {
    BoardStream stream;
    board.set_sample_limit(samples);
    board.on_line_state(true);
    while (!board.sample_limit_reached() && !board.unplugged()) {
        board.advance_to(board.now_ns() + 10 * ms);
        drain(board, stream);
    }
    while (!board.finish()) { drain(board, stream); }
    drain(board, stream);
    return stream;
}

VirtualBoardOptions at_rate(double rate_hz) {
    VirtualBoardOptions options;
    options.rate_hz = rate_hz;
    if (rate_hz > 1000.0) { options.dlpf_hz = 3600; }
    return options;
}

class BoardAtRate : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Rates, BoardAtRate, testing::Values(4.0, 100.0, 250.0, 1000.0, 2000.0, 8000.0));

TEST_P(BoardAtRate, StreamsExactlyTheSamplesAskedForWithoutALoss) {
    const double rate_hz = GetParam();
    const auto board = board_with(at_rate(rate_hz));
    const auto samples = static_cast<std::uint64_t>(3.0 * rate_hz + 5.0);
    const BoardStream stream = stream_samples(*board, samples);
    EXPECT_EQ(stream.indices.size(), samples);
    EXPECT_TRUE(stream.indices_consecutive());
    EXPECT_EQ(stream.lost_samples, 0U);
    EXPECT_EQ(stream.frames_refused(), 0U);
    EXPECT_EQ(stream.missing_sequences(), 0U);
    EXPECT_EQ(stream.config.rate_mHz, rate_hz * 1000.0);
}

TEST_P(BoardAtRate, DeliversTheCountsThatTheSimulatorDraws) {
    const double rate_hz = GetParam();
    VirtualBoardOptions options = at_rate(rate_hz);
    options.dlpf_hz = rate_hz < 400.0 ? 184 : 3600;  // above the band: it does not act
    options.seed = 99;
    const auto board = board_with(options);
    const BoardStream stream = stream_samples(*board, 1500);
    ASSERT_EQ(stream.gyro.size(), 1500U);

    SensorModel model = options.model;
    model.lsb_rad_s = rad_per_deg / 65.5;
    model.saturation_rad_s = 32767.0 * model.lsb_rad_s;
    SensorSimulator simulator(model, board->sensor().true_rate_hz(), 99);
    const SampleBlock* block = nullptr;
    for (std::size_t i = 0; i < stream.gyro.size(); ++i) {
        if (i % block_samples == 0) { block = &simulator.next_block(); }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ASSERT_EQ(stream.gyro[i][axis], block->counts[axis][i % block_samples]) << "sample " << i;
        }
    }
}

// A model as a file holds it: a step of five digits, a range that ends before the converter's.
TEST(VirtualBoard, TheModelsOwnConverterIsUsedAtItsFullScale) {
    VirtualBoardOptions options = at_rate(100.0);
    options.full_scale_dps = 500;
    options.model.lsb_rad_s = 0.01527 * rad_per_deg;
    options.model.saturation_rad_s = 245.0 * rad_per_deg;
    options.model.axes[0].bias_rad_s = 300.0 * rad_per_deg;
    options.model.axes[1].bias_rad_s = 200.0 * rad_per_deg;
    options.sensor_clock_error = 0.0;
    const BoardStream stream = stream_samples(*board_with(options), 900);
    SensorSimulator simulator(options.model, 100.0, options.seed);
    const SampleBlock& block = simulator.next_block();
    for (std::size_t i = 0; i < stream.gyro.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ASSERT_EQ(stream.gyro[i][axis], block.counts[axis][i]) << "sample " << i;
        }
    }
    EXPECT_EQ(stream.gyro[0][0], std::lround(245.0 / 0.01527));

    options.full_scale_dps = 1000;  // what the registers say then
    options.model.axes[0].noise = {};
    EXPECT_EQ(stream_samples(*board_with(options), 20).gyro[0][0], std::lround(300.0 * 32.8));
}

TEST(VirtualBoard, ItsTicksAreTheSimulatorsStamps) {
    VirtualBoardOptions options = at_rate(100.0);
    options.sensor_clock_error = 0.0;
    options.tick_clock_error = 0.0;
    options.model.timestamp_jitter_s = 300e-6;
    const BoardStream stream = stream_samples(*board_with(options), 5000);
    SensorSimulator simulator(options.model, 100.0, options.seed);
    std::vector<double> stamps_s;
    while (stamps_s.size() < 5000) {
        const SampleBlock& block = simulator.next_block();
        stamps_s.insert(stamps_s.end(), block.stamp_s.begin(), block.stamp_s.end());
    }
    for (std::size_t i = 0; i < stream.first_ticks.size(); ++i) {
        const double since_first_s = stamps_s[stream.first_indices[i]] - stamps_s[0];
        ASSERT_NEAR(static_cast<double>(stream.first_ticks[i] - stream.first_ticks[0]), since_first_s * 1e6,
                    1.01);
    }
}

// What was never offered cannot be counted: only the ticks tell.
TEST(VirtualBoard, SamplesThatTheModelLosesShowAsJumpsOfTheTicksAlone) {
    VirtualBoardOptions options = at_rate(100.0);
    options.sensor_clock_error = 0.0;
    options.tick_clock_error = 0.0;
    options.model.effects = {{"dropped", {}, {{"per_hour", 600.0}, {"longest", 12.0}}, ""}};
    const BoardStream stream = stream_samples(*board_with(options), 30'000);
    EXPECT_EQ(stream.indices.size(), 30'000U);
    EXPECT_TRUE(stream.indices_consecutive());
    EXPECT_EQ(stream.lost_samples, 0U);

    SensorSimulator simulator(options.model, 100.0, options.seed);
    std::vector<double> stamps_s;  // of what is not lost
    std::vector<std::array<std::int16_t, 3>> counts;
    std::size_t gaps = 0;
    bool lost = false;
    while (stamps_s.size() < 30'000) {
        const SampleBlock& block = simulator.next_block();
        for (std::size_t i = 0; i < block_samples; ++i) {
            if (!block.lost[i]) {
                stamps_s.push_back(block.stamp_s[i]);
                counts.push_back({block.counts[0][i], block.counts[1][i], block.counts[2][i]});
                if (lost && counts.size() > 1 && counts.size() <= 30'000) { ++gaps; }
            }
            lost = block.lost[i];
        }
    }
    counts.resize(30'000);
    EXPECT_EQ(stream.gyro, counts);
    EXPECT_EQ(static_cast<std::size_t>(std::count_if(
                  stream.flags.begin(), stream.flags.end(),
                  [](std::uint16_t flags) { return (flags & glp_flag_time_discontinuity) != 0; })),
              gaps);
    EXPECT_GT(gaps, 30U);
    for (std::size_t i = 0; i < stream.first_ticks.size(); ++i) {
        ASSERT_NEAR(static_cast<double>(stream.first_ticks[i] - stream.first_ticks[0]),
                    (stamps_s[stream.first_indices[i]] - stamps_s[0]) * 1e6, 1.01);
    }
}

TEST(VirtualBoard, ASensorThatLosesEverySampleFallsSilentAndIsCounted) {
    VirtualBoardOptions options = at_rate(1000.0);
    options.model.effects = {{"dropped", {}, {{"per_hour", 1e6}, {"longest", 1e6}}, ""}};
    const auto board = board_with(options);
    board->on_line_state(true);
    board->advance_to(10'000 * ms);
    EXPECT_EQ(board->sensor().next_instant_ns(), SimulatedMpu9250::never_ns);
    // By the nominal rate, from which the sensor's differs; up to 0.25 s may not be counted yet.
    EXPECT_NEAR(static_cast<double>(board->sampling_instants()), 9875.0, 130.0);
    BoardStream stream;
    drain(*board, stream);
    EXPECT_LT(stream.indices.size(), 1000U);
}

TEST(VirtualBoard, TheSameOptionsGiveTheSameBytes) {
    const auto run = [](std::uint64_t seed) {
        VirtualBoardOptions options = at_rate(1000.0);
        options.seed = seed;
        return stream_samples(*board_with(options), 2000);
    };
    const BoardStream first = run(5);
    EXPECT_EQ(first.gyro, run(5).gyro);
    EXPECT_EQ(first.first_ticks, run(5).first_ticks);
    EXPECT_NE(first.gyro, run(6).gyro);
}

TEST(VirtualBoard, ItsTicksShowTheErrorOfBothClocks) {
    VirtualBoardOptions options = at_rate(1000.0);
    options.sensor_clock_error = 0.004;
    options.tick_clock_error = 50e-6;
    options.model.timestamp_jitter_s = 0.0;
    const BoardStream stream = stream_samples(*board_with(options), 20'000);
    const auto ticks = static_cast<double>(stream.first_ticks.back() - stream.first_ticks.front());
    const auto samples = static_cast<double>(stream.first_indices.back() - stream.first_indices.front());
    EXPECT_NEAR(1e6 * samples / ticks, 1000.0 * 1.004 / (1.0 + 50e-6), 1000.0 / ticks);
}

TEST(VirtualBoard, ItsTicksJitterAsTheModelSays) {
    VirtualBoardOptions options = at_rate(100.0);
    options.sensor_clock_error = 0.0;
    options.tick_clock_error = 0.0;
    options.model.timestamp_jitter_s = 50e-6;
    const BoardStream stream = stream_samples(*board_with(options), 40'000);
    double variance = 0.0;
    const std::size_t frames = stream.first_ticks.size();
    for (std::size_t i = 1; i < frames; ++i) {
        const auto ticks = static_cast<double>(stream.first_ticks[i] - stream.first_ticks[i - 1]);
        const auto samples = static_cast<double>(stream.first_indices[i] - stream.first_indices[i - 1]);
        const double departure = ticks - 10'000.0 * samples;
        variance += departure * departure / static_cast<double>(frames - 1);
    }
    // A difference of two stamps: twice the variance. The kurtosis of differences that share a stamp costs
    // little.
    EXPECT_NEAR(variance / (2.0 * 50.0 * 50.0), 1.0, 5.0 * std::sqrt(3.0 / static_cast<double>(frames)));
}

TEST(VirtualBoard, TicksAndSequenceNumbersWrap) {
    VirtualBoardOptions options = at_rate(1000.0);
    options.first_tick = 0xFFFFFFFFU - 700'000U;
    options.first_sequence = 0xFFFFFFFAU;
    const BoardStream stream = stream_samples(*board_with(options), 3000);
    EXPECT_EQ(stream.sequences.front(), 0xFFFFFFFAU);
    EXPECT_EQ(stream.missing_sequences(), 0U);
    EXPECT_GT(stream.first_ticks.front(), stream.first_ticks.back());
    EXPECT_TRUE(stream.indices_consecutive());
}

TEST(VirtualBoard, AHostMayReconfigureIt) {
    const auto board = board_with(at_rate(100.0));
    BoardStream stream;
    board->on_receive(configure_bytes(200.0, 2000));
    drain(*board, stream);
    ASSERT_EQ(stream.replies.size(), 1U);
    EXPECT_EQ(stream.replies[0].result, glp_result_ok);
    EXPECT_EQ(stream.replies[0].command_sequence, 77U);
    const BoardStream after = stream_samples(*board, 400);
    EXPECT_EQ(after.config.rate_mHz, 200'000U);
    EXPECT_EQ(after.config.gyro_full_scale_dps, 2000U);
    EXPECT_TRUE(after.indices_consecutive());
}

TEST(VirtualBoard, ARateThatTheSensorLacksIsRefused) {
    const auto board = VirtualBoard::create(at_rate(999.0));
    ASSERT_FALSE(board.ok());
    EXPECT_EQ(board.error().code, ErrorCode::invalid_argument);
}

TEST(VirtualBoard, AnOverrunFifoIsCountedAndFlagged) {
    VirtualBoardOptions options = at_rate(1000.0);
    options.faults = {{.kind = BoardFault::Kind::fifo_overflow, .at_s = 1.0, .duration_s = 0.0}};
    const BoardStream stream = stream_samples(*board_with(options), 3000);
    EXPECT_GE(stream.lost_samples, 42U);  // a FIFO full of gyro and accelerometer samples
    EXPECT_EQ(stream.indices.size() + stream.lost_samples, 3000U);
    EXPECT_EQ(std::count(stream.events.begin(), stream.events.end(), glp_event_sensor_fifo_overflow), 1);
    EXPECT_EQ(std::count_if(stream.flags.begin(), stream.flags.end(),
                            [](std::uint16_t flags) { return (flags & glp_flag_sensor_fifo_overflow) != 0; }),
              1);
}

TEST(VirtualBoard, ABusErrorCostsAtMostTheFifo) {
    VirtualBoardOptions options = at_rate(1000.0);
    for (const double at_s : {0.5, 1.0, 1.5}) {
        options.faults.push_back({.kind = BoardFault::Kind::bus_error, .at_s = at_s, .duration_s = 0.0});
    }
    const BoardStream stream = stream_samples(*board_with(options), 3000);
    EXPECT_LE(stream.lost_samples, 3U * 42U);
    EXPECT_EQ(stream.indices.size() + stream.lost_samples, 3000U);
    EXPECT_EQ(stream.frames_refused(), 0U);
}

TEST(VirtualBoard, AStalledHostMakesTheRingOverflowInWholeFrames) {
    VirtualBoardOptions options = at_rate(1000.0);
    options.faults = {{.kind = BoardFault::Kind::link_stall, .at_s = 1.0, .duration_s = 2.0}};
    const BoardStream stream = stream_samples(*board_with(options), 5000);
    EXPECT_GT(stream.lost_samples, 1000U);
    EXPECT_EQ(stream.indices.size() + stream.lost_samples, 5000U);
    EXPECT_GT(stream.missing_sequences(), 10U);
    EXPECT_EQ(stream.frames_refused(), 0U);
    EXPECT_EQ(std::count(stream.events.begin(), stream.events.end(), glp_event_ring_overflow), 1);
}

TEST(VirtualBoard, DamageOnTheLinkCostsTheFramesItTouches) {
    for (const auto kind : {BoardFault::Kind::drop_packet, BoardFault::Kind::duplicate_packet,
                            BoardFault::Kind::corrupt_byte}) {
        VirtualBoardOptions options = at_rate(1000.0);
        // Not at a whole second: a STATUS frame then goes alone, and may be lost or doubled whole.
        options.faults = {{.kind = kind, .at_s = 1.3, .duration_s = 0.0}};
        const BoardStream stream = stream_samples(*board_with(options), 3000);
        EXPECT_GT(stream.bytes_skipped(), 0U);
        // Doubled bytes in front of a frame leave it intact.
        if (kind != BoardFault::Kind::duplicate_packet) { EXPECT_GE(stream.missing_sequences(), 1U); }
        EXPECT_LE(stream.missing_sequences(), 2U);
        EXPECT_EQ(stream.lost_samples, 0U);  // the board knows nothing of it
    }
}

TEST(VirtualBoard, AResetShowsAsANewBootIdWithinTheStream) {
    VirtualBoardOptions options = at_rate(100.0);
    options.boot_id = 41;
    options.faults = {{.kind = BoardFault::Kind::reset, .at_s = 1.0, .duration_s = 0.0}};
    const BoardStream stream = stream_samples(*board_with(options), 300);
    ASSERT_GE(stream.hellos.size(), 2U);
    EXPECT_EQ(stream.hellos.front().boot_id, 41U);
    EXPECT_EQ(stream.hellos.front().reset_cause, glp_reset_power_on);
    EXPECT_EQ(stream.hellos.back().boot_id, 42U);
    EXPECT_EQ(stream.hellos.back().reset_cause, glp_reset_watchdog);
    EXPECT_EQ(stream.config.rate_mHz, 100'000U);
}

TEST(VirtualBoard, AnUnpluggedBoardSaysNoMore) {
    VirtualBoardOptions options = at_rate(100.0);
    options.faults = {{.kind = BoardFault::Kind::unplug, .at_s = 1.0, .duration_s = 0.0}};
    const auto board = board_with(options);
    const BoardStream stream = stream_samples(*board, 300);
    EXPECT_TRUE(board->unplugged());
    EXPECT_LE(stream.indices.size(), 101U);
    EXPECT_GE(stream.indices.size(), 92U);  // but for the frame that was being filled
}

TEST(InEndpoint, AFlushEndsATransferShortOrWithAnEmptyPacket) {
    const Bytes data(300, 0x55);
    Bytes buffer(256);
    InEndpoint endpoint(1024);
    EXPECT_EQ(endpoint.take_transfer(buffer), std::nullopt);
    endpoint.write(ByteView(data).first(100));
    EXPECT_EQ(endpoint.take_transfer(buffer), std::nullopt);  // the last packet is not yet sent
    endpoint.flush();
    endpoint.flush();  // nothing between: nothing more to end
    EXPECT_EQ(endpoint.take_transfer(buffer), 100U);
    EXPECT_EQ(endpoint.take_transfer(buffer), std::nullopt);

    endpoint.write(ByteView(data).first(256));
    endpoint.flush();
    EXPECT_EQ(endpoint.take_transfer(buffer), 256U);
    EXPECT_EQ(endpoint.take_transfer(buffer), 0U);  // full packets need a ZLP to end
    EXPECT_EQ(endpoint.take_transfer(buffer), std::nullopt);

    endpoint.write(ByteView(data).first(128));
    endpoint.flush();
    EXPECT_EQ(endpoint.take_transfer(buffer), 128U);  // the ZLP ends this transfer, not another
    EXPECT_EQ(endpoint.take_transfer(buffer), std::nullopt);

    endpoint.write(data);  // 300: one full transfer, then a short one
    endpoint.flush();
    EXPECT_EQ(endpoint.take_transfer(buffer), 256U);
    EXPECT_EQ(endpoint.take_transfer(buffer), 44U);
}

TEST(InEndpoint, HoldsNoMoreThanItsCapacityAndKeepsTheOrder) {
    InEndpoint endpoint(100);
    Bytes sent;
    Bytes received;
    std::uint8_t next = 0;
    for (int round = 0; round < 500; ++round) {
        Bytes piece(static_cast<std::size_t>(round % 37));
        for (auto& byte : piece) { byte = next++; }
        const std::size_t accepted = endpoint.write(piece);
        next = static_cast<std::uint8_t>(next - (piece.size() - accepted));
        sent.insert(sent.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(accepted));
        ASSERT_LE(endpoint.pending_bytes(), 100U);
        Bytes buffer(static_cast<std::size_t>(round % 23));
        buffer.resize(endpoint.take_bytes(buffer));
        received.insert(received.end(), buffer.begin(), buffer.end());
    }
    Bytes rest(100);
    rest.resize(endpoint.take_bytes(rest));
    received.insert(received.end(), rest.begin(), rest.end());
    EXPECT_EQ(received, sent);
}

}  // namespace
}  // namespace gyrolog
