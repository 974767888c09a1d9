#include "analysis/recording/disturbances.hpp"

#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;
constexpr std::size_t rows = 30'000;

using Signals = std::vector<std::vector<double>>;

Recording grid_of(std::size_t count) {
    Recording recording;
    recording.rate_hz = rate_hz;
    Column column{"gx", "rad/s", std::vector<double>(count, 0.0)};
    recording.columns.push_back(std::move(column));
    recording.segments = {{0, count, 0}};
    return recording;
}

template <class Distribution>
Signals noise(std::uint64_t seed, Distribution distribution, std::size_t count = rows) {
    std::mt19937_64 random(seed);
    Signals signals(3, std::vector<double>(count));
    for (std::vector<double>& signal : signals) {
        for (double& value : signal) { value = distribution(random); }
    }
    return signals;
}

Signals white(std::uint64_t seed, std::size_t count = rows) {
    return noise(seed, std::normal_distribution<double>(), count);
}

void add_bump(Signals& signals, std::size_t at, double size) {
    for (std::size_t s = 0; s < signals.size(); ++s) {
        for (std::size_t i = at; i < std::min(at + 200, signals[s].size()); ++i) {
            const double since_s = static_cast<double>(i - at) / rate_hz;
            signals[s][i] += size * std::exp(-since_s / 0.3) * std::sin(2.0 * M_PI * 8.0 * since_s);
        }
    }
}

TEST(Disturbances, AreFoundWhereTheyAre) {
    Signals signals = white(1);
    add_bump(signals, 7000, 8.0);
    add_bump(signals, 21'000, 8.0);
    const std::vector<Disturbance> found = disturbances(grid_of(rows), signals);
    ASSERT_EQ(found.size(), 2U);
    for (const auto& [one, at_s] : {std::pair{found[0], 70.0}, std::pair{found[1], 210.0}}) {
        EXPECT_LE(one.from_s, at_s);
        EXPECT_GE(one.from_s, at_s - 1.0);
        EXPECT_GE(one.to_s, at_s + 0.5);
        EXPECT_LE(one.to_s, at_s + 2.0);
        EXPECT_EQ(one.loud.size(), 3U);
        EXPECT_GT(one.largest, 5.0);
        EXPECT_EQ(one.first, static_cast<std::size_t>(std::lround(one.from_s * rate_hz)));
    }
}

// Two half periods of 0.1 s in a block of 0.25 s are hardly more than a step.
TEST(Disturbances, AreFoundWhereTheySwingSlowly) {
    int found = 0;
    constexpr int recordings = 40;
    for (std::uint64_t seed = 1; seed <= recordings; ++seed) {
        Signals signals = white(500 + seed);
        const std::size_t at = 7000 + 3 * seed;  // anywhere in a block
        for (std::size_t i = at; i < at + 100; ++i) {
            const double since_s = static_cast<double>(i - at) / rate_hz;
            signals[0][i] += 13.0 * std::exp(-since_s / 0.12) * std::sin(2.0 * M_PI * 4.7 * since_s);
        }
        const std::vector<Disturbance> disturbed = disturbances(grid_of(rows), signals);
        found +=
            disturbed.size() == 1 && disturbed[0].first <= at && disturbed[0].first + disturbed[0].rows > at
                ? 1
                : 0;
    }
    std::cout << found << " of " << recordings << '\n';
    // 31 of these recordings; 13 if pulses have no rival, 15 with short blocks only.
    EXPECT_GE(found, 29);
}

TEST(Disturbances, AreFoundWhereTheRecordingBegins) {
    Signals signals = white(2);
    add_bump(signals, 0, 8.0);
    const std::vector<Disturbance> found = disturbances(grid_of(rows), signals);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].first, 0U);
}

// A short recording that begins with a touch as long as one may be.
TEST(Disturbances, AreFoundWhereAShortRecordingBegins) {
    constexpr std::size_t few = 3500;
    Signals signals = white(3, few);
    for (std::vector<double>& signal : signals) {
        for (std::size_t i = 0; i < 150; ++i) { signal[i] *= i < 50 ? 2.0 : 8.0; }
    }
    const std::vector<Disturbance> found = disturbances(grid_of(few), signals);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].first, 0U);
    EXPECT_GE(found[0].to_s, 1.5);
    EXPECT_LE(found[0].to_s, 2.0);
}

// A hand that lets go of a sensor takes its time, however short the recording is.
TEST(Disturbances, MayLastSecondsOfAShortRecording) {
    constexpr std::size_t short_rows = 3500;
    constexpr std::size_t touched_rows = 220;  // more than a twentieth
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Signals signals = white(seed, short_rows);
        for (std::vector<double>& signal : signals) {
            for (std::size_t i = 0; i < touched_rows; ++i) { signal[i] *= 6.0; }
        }
        const std::vector<Disturbance> found = disturbances(grid_of(short_rows), signals);
        ASSERT_EQ(found.size(), 1U) << seed;
        EXPECT_EQ(found[0].first, 0U) << seed;
        EXPECT_GE(found[0].rows, touched_rows) << seed;
        EXPECT_LE(found[0].rows, short_rows / 10) << seed;
    }
}

// Noise that swells to twice its size and back on all axes, as it does with the temperature, hides none.
TEST(Disturbances, AreFoundInNoiseWhoseLevelChanges) {
    Signals signals = white(8);
    for (std::vector<double>& signal : signals) {
        for (std::size_t i = 0; i < rows; ++i) {
            signal[i] *=
                1.5 - 0.5 * std::cos(2.0 * M_PI * static_cast<double>(i) / static_cast<double>(rows));
        }
    }
    EXPECT_TRUE(disturbances(grid_of(rows), signals).empty());
    add_bump(signals, 300, 5.0);
    const std::vector<Disturbance> found = disturbances(grid_of(rows), signals);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].from_s, 3.0, 0.5);
}

// A bump that rings for long is one until it drowns in the noise: of what is left no axis is loud by itself.
TEST(Disturbances, LastUntilTheyHaveRungOut) {
    Signals signals = white(9);
    constexpr double decay_s = 0.6;
    constexpr double size = 14.0;
    for (std::vector<double>& signal : signals) {
        for (std::size_t i = 7000; i < 7600; ++i) {
            const double since_s = static_cast<double>(i - 7000) / rate_hz;
            signal[i] += size * std::exp(-since_s / decay_s) * std::sin(2.0 * M_PI * 9.0 * since_s);
        }
    }
    const std::vector<Disturbance> found = disturbances(grid_of(rows), signals);
    ASSERT_EQ(found.size(), 1U);
    // There a swing is as large as the noise, to a block.
    EXPECT_GE(found[0].to_s, 70.0 + decay_s * std::log(size) - 0.25);
    EXPECT_LE(found[0].to_s, 73.0);
}

// A step that two axes share, single samples that are off on all, more noise on one axis for a while, and on
// all of them for a fifth of the time, are the sensor's own.
TEST(Disturbances, AreNotWhatASensorDoes) {
    Signals step = white(3);
    for (std::size_t s = 0; s < 2; ++s) {
        for (std::size_t i = 12'345; i < rows; ++i) { step[s][i] += 10.0; }
    }
    Signals spikes = white(4);
    for (std::vector<double>& signal : spikes) {
        for (std::size_t i = 500; i < rows; i += 2500) { signal[i] += 30.0; }
    }
    Signals one_axis = white(5);
    for (std::size_t i = 9000; i < 9500; ++i) { one_axis[1][i] *= 5.0; }
    Signals change = white(6);
    for (std::vector<double>& signal : change) {
        for (std::size_t i = rows - rows / 5; i < rows; ++i) { signal[i] *= 3.0; }
    }
    for (const Signals* signals : {&step, &spikes, &one_axis, &change}) {
        EXPECT_TRUE(disturbances(grid_of(rows), *signals).empty()) << signals - &step;
    }
}

// A bump may turn the sensor about one of its axes, and a sensor may have one.
TEST(Disturbances, AreFoundAboutOneAxis) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Signals signals = white(7);
        Signals turned = {signals[axis]};
        add_bump(turned, 7000, 12.0);
        signals[axis] = turned[0];
        const std::vector<Disturbance> found = disturbances(grid_of(rows), signals);
        ASSERT_EQ(found.size(), 1U) << axis;
        EXPECT_NEAR(found[0].from_s, 70.0, 1.0);
        EXPECT_EQ(found[0].loud, std::vector<std::size_t>{axis});
        EXPECT_EQ(disturbances(grid_of(rows), turned).size(), 1U);
    }
}

// Bumps of 3.5 standard deviations about two axes.
TEST(Disturbances, AreFoundThoughSmall) {
    constexpr int recordings = 100;
    int found = 0;
    for (std::uint64_t seed = 1; seed <= recordings; ++seed) {
        Signals signals = white(7000 + seed);
        Signals turned = {signals[0], signals[1]};
        add_bump(turned, 7000, 3.5);
        signals[0] = turned[0];
        signals[1] = turned[1];
        found += disturbances(grid_of(rows), signals).empty() ? 0 : 1;
    }
    std::cout << "of " << recordings << " small bumps " << found << " are found\n";
    EXPECT_GT(found, 65);
}

// Noise that is seldom loud on one axis, but often enough to be its own: two levels with a pulse now and
// then, spikes that come in numbers, codes that hardly change; or on all axes, with noise that they share.
Signals two_levels(std::uint64_t seed) {
    Signals signals = white(seed, 6000);
    std::mt19937_64 random(seed + 1);
    std::bernoulli_distribution jumps(0.002);
    double level = 0.0;
    for (double& value : signals[0]) {
        if (jumps(random)) { level = 12.0 - level; }
        value += level;
    }
    return signals;
}

// On all axes at the same instants, some of them three times in a block.
Signals many_spikes(std::uint64_t seed) {
    Signals signals = white(seed, 6000);
    std::mt19937_64 random(seed + 1);
    std::bernoulli_distribution is_spike(0.01);
    for (std::size_t i = 0; i < signals[0].size(); ++i) {
        if (!is_spike(random)) { continue; }
        for (std::vector<double>& signal : signals) { signal[i] += 20.0; }
    }
    return signals;
}

// Noise that the axes share.
Signals in_common(std::uint64_t seed) {
    Signals signals = white(seed, 6000);
    const Signals shared = white(seed + 1000, 6000);
    for (std::vector<double>& signal : signals) {
        for (std::size_t i = 0; i < signal.size(); ++i) { signal[i] += 4.0 * shared[0][i]; }
    }
    return signals;
}

Signals coarse_codes(std::uint64_t seed) {
    Signals signals = noise(seed, std::normal_distribution<double>(0.1, 0.15), 6000);
    for (std::vector<double>& signal : signals) {
        for (double& value : signal) { value = std::round(value); }
    }
    return signals;
}

// The chance is one in 100 each; 12 of 200 is one in 10^6 by Poisson's law.
TEST(Disturbances, AreNotWhatASensorSeldomDoes) {
    constexpr std::uint64_t recordings = 200;
    int found_levels = 0;
    int found_spikes = 0;
    int found_codes = 0;
    int found_common = 0;
    for (std::uint64_t seed = 1; seed <= recordings; ++seed) {
        const Recording grid = grid_of(6000);
        found_levels += disturbances(grid, two_levels(seed)).empty() ? 0 : 1;
        found_spikes += disturbances(grid, many_spikes(seed)).empty() ? 0 : 1;
        found_codes += disturbances(grid, coarse_codes(seed)).empty() ? 0 : 1;
        found_common += disturbances(grid, in_common(seed)).empty() ? 0 : 1;
    }
    std::cout << "of " << recordings << " recordings: two levels " << found_levels << ", spikes "
              << found_spikes << ", codes " << found_codes << ", noise in common " << found_common << '\n';
    EXPECT_LT(found_levels, 12);
    EXPECT_LT(found_spikes, 12);
    EXPECT_LT(found_codes, 12);
    EXPECT_LT(found_common, 12);
}

// The chance is one in 100 each; 29 of 1000 or more is one in 10^6 by Poisson's law.
TEST(Disturbances, AreRareWhereThereAreNone) {
    constexpr std::uint64_t recordings = 1000;
    int normal = 0;
    int heavy = 0;
    for (std::uint64_t seed = 1; seed <= recordings; ++seed) {
        const Recording grid = grid_of(6000);
        if (!disturbances(grid, white(1000 + seed, 6000)).empty()) { ++normal; }
        const Signals tails = noise(5000 + seed, std::student_t_distribution<double>(3.5), 6000);
        if (!disturbances(grid, tails).empty()) { ++heavy; }
    }
    std::cout << "of " << recordings << " recordings: normal noise " << normal << ", heavy tails " << heavy
              << '\n';
    EXPECT_LT(normal, 29);
    EXPECT_LT(heavy, 29);
}

}  // namespace
}  // namespace gyrolog
