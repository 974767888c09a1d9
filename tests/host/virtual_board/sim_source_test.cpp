#include "host/virtual_board/sim_source.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "tests/host/virtual_board/board_stream.hpp"

namespace gyrolog {
namespace {

// Keeps what comes; refuses every so many-th transfer when asked to.
class Collector final : public TransferSink {
public:
    bool on_transfer(const Transfer& transfer) override {
        if (refuse_every != 0 && ++asked % refuse_every == 0) { return false; }
        const std::lock_guard lock(mutex);
        if (transfer.carries_stream()) {
            stream.feed(transfer.data);
            data_bytes += transfer.data.size();
            statuses.push_back(transfer.status);
        }
        if (transfer.kind == TransferKind::control) { ++control_events; }
        if (transfer.kind == TransferKind::bulk && transfer.endpoint == 0x01) { ++out_events; }
        if (transfer.kind == TransferKind::bulk) { endpoints.insert(transfer.endpoint); }
        EXPECT_GE(transfer.time.monotonic_ns, last_ns - 1);
        if (transfer.event == Transfer::Event::completion) { last_ns = transfer.time.monotonic_ns; }
        return true;
    }
    void on_end(SourceEnd how, const std::optional<Error>& /*error*/) override {
        const std::lock_guard lock(mutex);
        end = how;
        changed.notify_all();
    }
    SourceEnd wait_for_end() {
        std::unique_lock lock(mutex);
        EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(20), [&] { return end.has_value(); }));
        return end.value_or(SourceEnd::failed);
    }

    unsigned refuse_every = 0;
    unsigned asked = 0;
    std::mutex mutex;
    std::condition_variable changed;
    BoardStream stream;
    std::size_t data_bytes = 0;
    std::vector<int> statuses;
    int control_events = 0;
    int out_events = 0;
    std::set<std::uint8_t> endpoints;  // of bulk transfers
    std::int64_t last_ns = 0;
    std::optional<SourceEnd> end;
};

std::unique_ptr<SimSource> source_of(const SimOptions& options, const SimLimit& limit) {
    auto source = SimSource::create(options, typical_mpu9250(), limit);
    EXPECT_TRUE(source.ok()) << (source.ok() ? "" : source.error().message);
    return std::move(source).value();
}

SimOptions at_rate(double rate_hz) {
    SimOptions options;
    options.rate_hz = rate_hz;
    return options;
}

TEST(SimSource, EndsAfterExactlyTheSamplesAskedFor) {
    for (const double rate_hz : {100.0, 1000.0, 8000.0}) {
        Collector sink;
        const auto source = source_of(at_rate(rate_hz), {.samples = 12'345, .duration_s = {}});
        ASSERT_TRUE(source->start(sink).ok());
        ASSERT_TRUE(source->set_line_state(false).ok());
        ASSERT_TRUE(source->set_line_state(true).ok());
        EXPECT_EQ(sink.wait_for_end(), SourceEnd::exhausted);
        source->stop();
        EXPECT_EQ(sink.stream.indices.size(), 12'345U);
        EXPECT_TRUE(sink.stream.indices_consecutive());
        EXPECT_EQ(sink.stream.frames_refused(), 0U);
        EXPECT_EQ(sink.control_events, 4);
    }
}

TEST(SimSource, EndsAfterTheDurationInSimulatedTime) {
    Collector sink;
    const auto source = source_of(at_rate(1000.0), {.samples = {}, .duration_s = 60.0});
    const std::int64_t start_ns = host_now().monotonic_ns;
    ASSERT_TRUE(source->start(sink).ok());
    ASSERT_TRUE(source->set_line_state(true).ok());
    EXPECT_EQ(sink.wait_for_end(), SourceEnd::exhausted);
    source->stop();
    EXPECT_NEAR(static_cast<double>(sink.stream.indices.size()), 60'000.0, 60.0);
    // The stamps ran ahead of the clock with the board.
    EXPECT_NEAR(static_cast<double>(sink.last_ns - start_ns) * 1e-9, 60.0, 15.0);
}

TEST(SimSource, LosesNothingToASinkWithoutRoom) {
    Collector sink;
    const auto source = source_of(at_rate(1000.0), {.samples = 100'000, .duration_s = {}});
    sink.refuse_every = 3;
    ASSERT_TRUE(source->start(sink).ok());
    ASSERT_TRUE(source->set_line_state(true).ok());
    EXPECT_EQ(sink.wait_for_end(), SourceEnd::exhausted);
    source->stop();
    EXPECT_EQ(sink.stream.indices.size(), 100'000U);
    EXPECT_TRUE(sink.stream.indices_consecutive());
}

TEST(SimSource, ACommandBeforeTheStartIsAnsweredAndObeyed) {
    Collector sink;
    const auto source = source_of(at_rate(100.0), {.samples = 500, .duration_s = {}});
    ASSERT_TRUE(source->start(sink).ok());
    ASSERT_TRUE(source->set_line_state(false).ok());
    ASSERT_TRUE(source->write(configure_bytes(500.0, 1000)).ok());
    ASSERT_TRUE(source->set_line_state(true).ok());
    EXPECT_EQ(sink.wait_for_end(), SourceEnd::exhausted);
    source->stop();
    ASSERT_EQ(sink.stream.replies.size(), 1U);
    EXPECT_EQ(sink.stream.replies[0].result, glp_result_ok);
    EXPECT_EQ(sink.stream.config.rate_mHz, 500'000U);
    EXPECT_EQ(sink.stream.config.gyro_full_scale_dps, 1000U);
    EXPECT_EQ(sink.stream.indices.size(), 500U);
    EXPECT_EQ(sink.out_events, 2);
}

TEST(SimSource, SpeaksByTheEndpointsOfItsDescriptor) {
    for (const UsbEndpoints& endpoints : {UsbEndpoints{}, fixed_kind_endpoints}) {
        Collector sink;
        SimOptions options = at_rate(100.0);
        options.endpoints = endpoints;
        const auto source = source_of(options, {.samples = 100, .duration_s = {}});
        EXPECT_EQ(source->identity().configuration_descriptor, configuration_descriptor(endpoints));
        ASSERT_TRUE(source->start(sink).ok());
        ASSERT_TRUE(source->write(configure_bytes(500.0, 1000)).ok());
        ASSERT_TRUE(source->set_line_state(true).ok());
        EXPECT_EQ(sink.wait_for_end(), SourceEnd::exhausted);
        source->stop();
        EXPECT_EQ(sink.endpoints, (std::set<std::uint8_t>{endpoints.in, endpoints.out}));
    }
}

TEST(SimSource, StopsWhenToldWhileItStreamsWithoutEnd) {
    Collector sink;
    const auto source = source_of(at_rate(1000.0), {});
    ASSERT_TRUE(source->start(sink).ok());
    ASSERT_TRUE(source->set_line_state(true).ok());
    while (true) {
        const std::lock_guard lock(sink.mutex);
        if (sink.data_bytes > 100'000) { break; }
    }
    ASSERT_TRUE(source->set_line_state(false).ok());
    source->stop();
    EXPECT_EQ(sink.end, SourceEnd::stopped);
    EXPECT_TRUE(sink.stream.indices_consecutive());
    EXPECT_EQ(sink.stream.events.back(), glp_event_stopped);
    EXPECT_FALSE(source->write(Bytes{0}).ok());
}

TEST(SimSource, AnUnpluggedBoardEndsAsALostDevice) {
    SimOptions options = at_rate(100.0);
    options.faults = {{.kind = BoardFault::Kind::unplug, .at_s = 2.0, .duration_s = 0.0}};
    Collector sink;
    const auto source = source_of(options, {});
    ASSERT_TRUE(source->start(sink).ok());
    ASSERT_TRUE(source->set_line_state(true).ok());
    EXPECT_EQ(sink.wait_for_end(), SourceEnd::device_lost);
    source->stop();
    EXPECT_EQ(sink.statuses.back(), -108);  // ESHUTDOWN
    EXPECT_GE(sink.stream.indices.size(), 192U);
}

// The board sends what it has once the link takes it again.
TEST(SimSource, EndsWhenItsLastSamplesCameDuringAStall) {
    SimOptions options = at_rate(1000.0);
    options.faults = {{.kind = BoardFault::Kind::link_stall, .at_s = 1.8, .duration_s = 5.0}};
    Collector sink;
    const auto source = source_of(options, {.samples = 2000, .duration_s = {}});
    ASSERT_TRUE(source->start(sink).ok());
    ASSERT_TRUE(source->set_line_state(true).ok());
    EXPECT_EQ(sink.wait_for_end(), SourceEnd::exhausted);
    source->stop();
    EXPECT_EQ(sink.stream.indices.size(), 2000U);
}

TEST(SimSource, StopsWhenToldWhileTheLinkIsStalled) {
    SimOptions options = at_rate(1000.0);
    options.realtime = true;
    options.faults = {{.kind = BoardFault::Kind::link_stall, .at_s = 0.2, .duration_s = 60.0}};
    Collector sink;
    const auto source = source_of(options, {.samples = 300, .duration_s = {}});
    ASSERT_TRUE(source->start(sink).ok());
    ASSERT_TRUE(source->set_line_state(true).ok());
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    ASSERT_TRUE(source->set_line_state(false).ok());
    source->stop();
    EXPECT_EQ(sink.wait_for_end(), SourceEnd::stopped);
    EXPECT_LT(sink.stream.indices.size(), 300U);
}

TEST(SimSource, KeepsToTheClockInRealTime) {
    SimOptions options = at_rate(1000.0);
    options.realtime = true;
    Collector sink;
    const auto source = source_of(options, {.samples = 300, .duration_s = {}});
    const std::int64_t start_ns = host_now().monotonic_ns;
    ASSERT_TRUE(source->start(sink).ok());
    ASSERT_TRUE(source->set_line_state(true).ok());
    EXPECT_EQ(sink.wait_for_end(), SourceEnd::exhausted);
    source->stop();
    EXPECT_GE(host_now().monotonic_ns - start_ns, 295'000'000);
    EXPECT_EQ(sink.stream.indices.size(), 300U);
    EXPECT_GT(sink.statuses.size(), 5U);  // a transfer for each frame
}

TEST(SimSource, BoardsOfOneSeedAreDifferentSensorsWithTheirOwnNames) {
    std::vector<std::vector<std::array<std::int16_t, 3>>> gyros;
    for (const unsigned board : {1U, 2U}) {
        SimOptions options = at_rate(100.0);
        options.boards = 2;
        options.board = board;
        const auto source = source_of(options, {.samples = 200, .duration_s = {}});
        EXPECT_EQ(source->identity().serial, "SIM000" + std::to_string(board));
        EXPECT_EQ(source->identity().uri, "sim:board=" + std::to_string(board));
        Collector sink;
        ASSERT_TRUE(source->start(sink).ok());
        ASSERT_TRUE(source->set_line_state(true).ok());
        sink.wait_for_end();
        source->stop();
        gyros.push_back(sink.stream.gyro);
    }
    EXPECT_NE(gyros[0], gyros[1]);
}

TEST(SimSource, TakesRateAndClockErrorFromTheModel) {
    SensorModel model = typical_mpu9250();
    model.rate_hz = 200.5;
    const auto source = SimSource::create({}, model, {.samples = 4000, .duration_s = {}});
    ASSERT_TRUE(source.ok());
    Collector sink;
    ASSERT_TRUE((*source)->start(sink).ok());
    ASSERT_TRUE((*source)->set_line_state(true).ok());
    sink.wait_for_end();
    (*source)->stop();
    EXPECT_EQ(sink.stream.config.rate_mHz, 200'000U);
    const auto ticks = static_cast<double>(sink.stream.first_ticks.back() - sink.stream.first_ticks.front());
    const auto samples =
        static_cast<double>(sink.stream.first_indices.back() - sink.stream.first_indices.front());
    EXPECT_NEAR(1e6 * samples / ticks, 200.5, 200.5 * 2e-4);  // 20 ppm of the tick clock, and its jitter
    model.rate_hz = 97.0;
    EXPECT_FALSE(SimSource::create({}, model, {}).ok());
}

}  // namespace
}  // namespace gyrolog
