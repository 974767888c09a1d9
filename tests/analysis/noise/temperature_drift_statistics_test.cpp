// What is true of the drift with temperature over many records whose noise knows nothing of the temperature:
// how often the stated deviation holds the truth, and how often a drift is seen where there is none. A drift
// that is there moves the slope and nothing else (temperature_drift_test.cpp), so none has to be added.

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/noise/temperature_drift.hpp"
#include "tests/analysis/noise/over_seeds.hpp"
#include "tests/analysis/noise/shaped_noise.hpp"
#include "tests/analysis/noise/temperature_courses.hpp"

namespace gyrolog {
namespace {

using test::Course;

constexpr std::size_t samples = 1280;
constexpr double rate_hz = 1.0;
constexpr std::size_t axes = 10;  // of noise with the same temperature
constexpr double within_one_sd = 0.6827;
constexpr double false_alarm = 0.001;

struct Kind {
    const char* name;
    NoiseCoefficients noise;
};

// Blocks are 10 s. Flicker and walk of the second and third are above the white noise of every block's mean;
// in the others they come up at a twentieth of a block's frequency.
constexpr std::array<Kind, 5> kinds = {{{"white", {0.0, 0.01, 0.0, 0.0, 0.0}},
                                        {"flicker", {0.0, 1e-4, 0.01, 0.0, 0.0}},
                                        {"walk", {0.0, 1e-4, 0.0, 0.01, 0.0}},
                                        {"white and flicker", {0.0, 0.01, 0.0018, 0.0, 0.0}},
                                        {"white, flicker and walk", {0.0, 0.01, 0.0018, 1.3e-4, 0.0}}}};
constexpr std::array<const char*, 3> courses = {"ramp", "warm-up", "walk"};

struct Tally {
    int records = 0;
    int within = 0;
    int alarms_5 = 0;  // at a chance of 5 %, and of 0.1 %
    int alarms = 0;

    double share() const { return static_cast<double>(within) / records; }
    Tally& operator+=(const Tally& other) {
        records += other.records;
        within += other.within;
        alarms_5 += other.alarms_5;
        alarms += other.alarms;
        return *this;
    }
};

// Standard deviation of a count of `records` of this chance.
double count_sd(double records, double chance) { return std::sqrt(records * chance * (1.0 - chance)); }

Tally tally_of(const Kind& kind, Course course, std::uint64_t seed) {
    std::vector<std::vector<double>> columns;
    for (std::uint64_t axis = 0; axis < axes; ++axis) {
        columns.push_back(test::shaped_noise(kind.noise, samples, rate_hz, axes * seed + axis));
    }
    const Recording recording = test::with_temperature(
        std::move(columns), rate_hz, test::temperature_course(course, samples, 1'000'000 + seed));
    std::vector<const Column*> wanted;
    for (std::size_t axis = 0; axis < axes; ++axis) { wanted.push_back(&recording.columns[axis]); }
    Tally tally;
    for (const auto& drift : temperature_drifts(recording, wanted)) {
        ++tally.records;
        tally.within += std::abs(drift->slope_per_C) < drift->sd_per_C ? 1 : 0;
        tally.alarms_5 += drift->chance < 0.05 ? 1 : 0;
        tally.alarms += drift->is_there ? 1 : 0;
    }
    return tally;
}

using Tallies = std::array<std::array<Tally, courses.size()>, kinds.size()>;

const Tallies& tallies() {
    static const Tallies all = [] {
        Tallies result{};
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            for (std::size_t c = 0; c < courses.size(); ++c) {
                const auto each = test::over_seeds(test::realisations(10), [&](std::uint64_t seed) {
                    return tally_of(kinds[k], static_cast<Course>(c), seed);
                });
                for (const Tally& one : each) { result[k][c] += one; }
                const Tally& sum = result[k][c];
                std::printf(
                    "%-24s %-8s %5d records: %.3f within one deviation; chance below 5 %%: %.4f, "
                    "0.1 %%: %d\n",
                    kinds[k].name, courses[c], sum.records, sum.share(),
                    static_cast<double>(sum.alarms_5) / sum.records, sum.alarms);
            }
        }
        return result;
    }();
    return all;
}

TEST(TemperatureDriftStatistics, DeviationsHoldTheTruthWhereRandomWalkDominates) {
    for (std::size_t c = 0; c < courses.size(); ++c) {
        const Tally& walk = tallies()[2][c];
        EXPECT_NEAR(walk.within, within_one_sd * walk.records, 3.5 * count_sd(walk.records, within_one_sd))
            << courses[c];
    }
}

// Where a walk might hide below what the record shows, the deviation has to allow for it: it holds the truth
// too often, never much too seldom.
TEST(TemperatureDriftStatistics, DeviationsHoldTheTruthWhateverTheNoise) {
    Tally all;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        for (std::size_t c = 0; c < courses.size(); ++c) {
            const Tally& one = tallies()[k][c];
            all += one;
            const double sd = count_sd(one.records, within_one_sd) / one.records;
            EXPECT_GT(one.share(), within_one_sd - 0.04 - 3.5 * sd) << kinds[k].name << ' ' << courses[c];
            EXPECT_LT(one.share(), 0.85 + 3.5 * sd) << kinds[k].name << ' ' << courses[c];
        }
    }
    EXPECT_GT(all.within, within_one_sd * all.records - 3.5 * count_sd(all.records, within_one_sd));
    EXPECT_LT(all.share(), 0.74);
}

TEST(TemperatureDriftStatistics, SeesNoDriftWhereThereIsNoneMoreOftenThanStated) {
    Tally all;
    for (const auto& of_kind : tallies()) {
        for (const Tally& one : of_kind) { all += one; }
    }
    EXPECT_LE(all.alarms_5, 0.05 * all.records + 3.5 * count_sd(all.records, 0.05));
    EXPECT_GE(all.alarms_5, 0.02 * all.records);  // it does see what chance gives
    EXPECT_LE(all.alarms, false_alarm * all.records + 3.5 * count_sd(all.records, false_alarm));
}

}  // namespace
}  // namespace gyrolog
