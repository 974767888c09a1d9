// What a long simulation takes of memory, by counting what is allocated. GYROLOG_LONG_HOURS asks for longer
// ones.

#include <gtest/gtest.h>

#include "analysis/simulate/recording_simulator.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/asked.hpp"
#include "tests/support/heap_account.hpp"

namespace gyrolog {
namespace {

std::size_t most_bytes_of(double hours) {
    SensorModel model = typical_mpu9250();
    model.effects = {{.effect = "dropped", .axes = {}, .params = {{"per_hour", 100.0}}, .carried_json = {}},
                     {.effect = "rtn",
                      .axes = {},
                      .params = {{"amplitude_dps", 0.01}, {"dwell_high_s", 5.0}, {"dwell_low_s", 5.0}},
                      .carried_json = {}},
                     {.effect = "lowpass", .axes = {}, .params = {{"fc_hz", 92.0}}, .carried_json = {}},
                     {.effect = "spikes",
                      .axes = {},
                      .params = {{"per_hour", 100.0}, {"smallest_dps", 1.0}, {"largest_dps", 2.0}},
                      .carried_json = {}}};
    EXPECT_EQ(simulation_refusal(model), std::nullopt);
    const std::size_t before = bytes_now;
    bytes_most = before;
    RecordingSimulator simulator(
        model, {.samples = static_cast<std::uint64_t>(hours * 3.6e6), .seed = 1, .rate_hz = 1000.0});
    auto writer =
        RecordingCsvWriter::create("/dev/null", {.rate_unit = {}, .resolved = simulator.simulated_columns()});
    EXPECT_TRUE(writer.ok());
    Recording piece;
    while (simulator.next(piece)) { EXPECT_TRUE(writer->append(piece).ok()); }
    EXPECT_TRUE(writer->close().ok());
    return bytes_most - before;
}

TEST(SimulationMemory, DoesNotGrowWithTheLengthOfTheRecording) {
    const double hours = asked("GYROLOG_LONG_HOURS", 1.0);
    const std::size_t some = most_bytes_of(hours / 20.0);
    const std::size_t twenty_times = most_bytes_of(hours);
    EXPECT_GT(some, sizeof(SampleBlock)) << "the block alone: less is not counted";
    EXPECT_LT(twenty_times, some + 100'000) << some << " bytes";
    EXPECT_LT(twenty_times, 8'000'000U);
}

}  // namespace
}  // namespace gyrolog
