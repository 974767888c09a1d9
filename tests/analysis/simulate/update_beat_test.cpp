#include "analysis/simulate/update_beat.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/simulate/recording_simulator.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;
constexpr std::uint64_t samples = 60'000;

Recording recorded(const SensorModel& model, std::uint64_t seed) {
    SimulationRequest request;
    request.seed = seed;
    request.samples = samples;
    request.rate_hz = rate_hz;
    return simulate_recording(model, request);
}

// Of the moments that the samples show, the simulator's own.
std::vector<double> ages_of(const SensorModel& model, std::uint64_t seed) {
    SensorSimulator simulator(model, rate_hz, seed);
    std::vector<double> ages;
    while (ages.size() < samples) {
        const SampleBlock& block = simulator.next_block();
        for (std::size_t i = 0; i < block_samples; ++i) {
            ages.push_back(static_cast<double>(block.first_index + i) - block.world_s[i] * rate_hz);
        }
    }
    return ages;
}

// The largest error but for the samples at which an update is as good as due: there it is a whole period.
double worst_age_error(const UpdateBeat& beat, const std::vector<double>& ages) {
    const double period = 1.0 / (1.0 - beat.eps());
    double worst = 0.0;
    for (std::size_t k = 0; k < samples; ++k) {
        const double error = std::fabs(beat.at(k).age_samples - ages[k]);
        worst = std::max(worst, std::min(error, std::fabs(error - period)));
    }
    return worst;
}

TEST(UpdateBeat, IsReadFromTheRepeatsOfARecording) {
    for (const double eps : {4.1e-4, 1.013e-3, 0.0722, 0.3, 0.4537, 0.78}) {
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            const SensorModel model = with_effect(white_model(0.01), "stale", {{"eps", eps}});
            const auto beat = recorded_beat(recorded(model, seed));
            ASSERT_TRUE(beat) << eps << ' ' << seed;
            EXPECT_NEAR(beat->eps(), eps, 3e-6) << seed;
            EXPECT_LT(worst_age_error(*beat, ages_of(model, seed)), 0.05 + 0.15 * eps) << eps << ' ' << seed;
        }
    }
}

// Short segments, and a hole as long as the recording.
TEST(UpdateBeat, IsReadAcrossHoles) {
    for (const double eps : {0.003, 0.0722}) {
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            const SensorModel model = with_effect(white_model(0.01), "stale", {{"eps", eps}});
            const Recording whole = recorded(model, seed);
            const std::size_t kept = eps > 0.01 ? 19 : 20'000;
            const std::size_t period = eps > 0.01 ? 23 : 40'000;
            Recording parts = whole;
            parts.segments.clear();
            for (std::size_t at = 0; at + kept <= samples; at += period) {
                parts.segments.push_back({at, kept, static_cast<std::int64_t>(at)});
            }
            const auto beat = recorded_beat(parts);
            ASSERT_TRUE(beat) << eps << ' ' << seed;
            const std::vector<double> ages = ages_of(model, seed);
            std::size_t late = 0;
            for (const Segment& segment : parts.segments) {
                for (std::size_t k = segment.first; k < segment.first + segment.count; ++k) {
                    late += std::fabs(beat->at(k).age_samples - ages[k]) > 0.1 ? 1U : 0U;
                }
            }
            EXPECT_LT(static_cast<double>(late), 0.05 * samples) << eps << ' ' << seed;
        }
    }
}

// Codes so coarse that one in twenty-five samples repeats by chance on all axes: half as many as in the beat.
TEST(UpdateBeat, IsReadBesideRepeatsByChance) {
    SensorModel model = with_effect(white_model(0.01), "stale", {{"eps", 0.0722}});
    model.lsb_rad_s = 0.12;
    const Recording recording = recorded(model, 4);
    const Column& x = *recording.find("gx");
    const Column& y = *recording.find("gy");
    const Column& z = *recording.find("gz");
    double repeats = 0.0;
    for (std::size_t row = 1; row < recording.rows(); ++row) {
        const bool same = x.value(row) == x.value(row - 1) && y.value(row) == y.value(row - 1) &&
                          z.value(row) == z.value(row - 1);
        repeats += same ? 1.0 : 0.0;
    }
    EXPECT_GT(repeats / static_cast<double>(samples), 0.09);
    const auto beat = recorded_beat(recording);
    ASSERT_TRUE(beat);
    EXPECT_NEAR(beat->eps(), 0.0722, 1e-5);
    EXPECT_LT(worst_age_error(*beat, ages_of(model, 4)), 0.06);
}

// Two clocks that drift apart: by a ten-thousandth within ten minutes.
TEST(UpdateBeat, FollowsClocksThatDrift) {
    Recording recording = recorded(white_model(0.01), 5);
    const auto updates = [](double k) { return k * (0.9 + 1e-4 * k / samples) + 0.3; };
    Column& x = *std::ranges::find(recording.columns, "gx", &Column::name);
    std::erase_if(recording.columns, [](const Column& column) { return column.name != "gx"; });
    std::vector<double> values = x.values();
    for (std::size_t k = 1; k < samples; ++k) {
        const auto at = static_cast<double>(k);
        if (std::floor(updates(at)) == std::floor(updates(at - 1.0))) { values[k] = values[k - 1]; }
    }
    recording.columns.front().data = values;
    const auto beat = recorded_beat(recording);
    ASSERT_TRUE(beat);
    double worst = 0.0;
    for (std::size_t k = 0; k < samples; ++k) {
        const double at = updates(static_cast<double>(k));
        const double age = (at - std::floor(at)) / 0.9001;
        const double error = std::fabs(beat->at(k).age_samples - age);
        worst = std::max(worst, std::min(error, std::fabs(error - 1.0 / 0.9001)));
    }
    EXPECT_LT(worst, 0.06);
}

TEST(UpdateBeat, IsNoneWhereRepeatsComeAtRandomOrNotAtAll) {
    EXPECT_FALSE(recorded_beat(recorded(white_model(0.01), 1)));
    SensorModel coarse = white_model(0.01);
    coarse.lsb_rad_s = 0.1;
    EXPECT_FALSE(recorded_beat(recorded(coarse, 1)));
    for (const double eps : {0.02, 0.3}) {
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            const SensorModel random =
                with_effect(white_model(0.01), "stale", {{"eps", eps}, {"run_length", 1.5}});
            EXPECT_FALSE(recorded_beat(recorded(random, seed))) << eps << ' ' << seed;
        }
    }
}

// Whatever the phase, the first sample of all repeats none.
TEST(UpdateBeat, IsThatOfASimulationLikeTheRecording) {
    SensorModel model = with_effect(white_model(0.01), "stale", {{"eps", 0.3}});
    for (AxisModel& axis : model.axes) { axis.bias_rad_s = 1.0; }
    SensorModel noiseless = with_effect(ideal_model(), "stale", {{"eps", 0.3}});
    for (AxisModel& axis : noiseless.axes) { axis.bias_rad_s = 1.0; }
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SimulationRequest request;
        request.seed = 100 + seed;
        request.like =
            std::make_shared<const RecordedWorld>(std::make_shared<const Recording>(recorded(model, seed)));
        const Recording& seen = request.like->recording();
        const Recording again = simulate_recording(model, request);
        std::size_t others = 0;
        for (std::size_t row = 1; row < seen.rows(); ++row) {
            const auto repeats = [row](const Recording& recording) {
                const Column& x = *recording.find("gx");
                return x.value(row) == x.value(row - 1);
            };
            others += repeats(seen) == repeats(again) ? 0U : 1U;
        }
        // At the beat's very edges, and by no more than a row.
        EXPECT_LT(others, samples / 50) << seed;
        const Recording still = simulate_recording(noiseless, request);
        for (std::size_t row = 0; row < still.rows(); ++row) {
            ASSERT_NEAR(still.find("gx")->value(row), 1.0, 1e-12) << seed << ' ' << row;
        }
    }
}

}  // namespace
}  // namespace gyrolog
