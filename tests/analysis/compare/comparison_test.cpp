#include "analysis/compare/comparison.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/simulate/counter_random.hpp"
#include "analysis/simulate/recording_simulator.hpp"

namespace gyrolog {
namespace {

std::shared_ptr<Recording> recording_of(const SensorModel& model, std::uint64_t seed,
                                        std::uint64_t samples = 12'000) {
    SimulationRequest request;
    request.samples = samples;
    request.seed = seed;
    auto recording = std::make_shared<Recording>(simulate_recording(model, request));
    recording->name = "night.csv";
    return recording;
}

ModelComparisonOptions quick() {
    ModelComparisonOptions options;
    options.simulations = 39;
    return options;
}

Comparison against_model(const std::shared_ptr<Recording>& recording, const SensorModel& model) {
    auto comparison = compare_with_model(recording, model, "model.json", quick());
    EXPECT_TRUE(comparison.has_value());
    return comparison.value_or(Comparison{});
}

TEST(Comparison, OfASimulationWithItsOwnModelFindsLittle) {
    const SensorModel model = typical_mpu9250();
    int found = 0;
    std::size_t outside = 0;
    double by_chance = 0.0;
    for (std::uint64_t seed = 100; seed < 104; ++seed) {
        const Comparison comparison = against_model(recording_of(model, seed), model);
        ASSERT_EQ(comparison.axes.size(), 3U);
        for (const AxisComparison& axis : comparison.axes) {
            found += axis.worst() != nullptr || axis.worst_number() != nullptr ? 1 : 0;
            outside += axis.spectrum.points_outside();
            by_chance += axis.spectrum.points_by_chance;
        }
    }
    // 4 recordings, of which at most 5 % show one.
    EXPECT_LE(found, 1);
    EXPECT_NEAR(static_cast<double>(outside), by_chance, 6.0 * std::sqrt(by_chance));
}

TEST(Comparison, FindsTheAxisThatIsNoisierAndByHowMuch) {
    const SensorModel model = typical_mpu9250();
    SensorModel noisier = model;
    noisier.axes[1].noise.N_rad_per_sqrt_s *= 1.5;
    const Comparison comparison = against_model(recording_of(noisier, 5), model);
    const AxisComparison& y = comparison.axes.at(1);
    ASSERT_NE(y.worst(), nullptr);
    EXPECT_GT(y.allan.points_outside(), 20U);
    EXPECT_NEAR(y.allan.outside.front().from, 0.01, 1e-6);
    // 12 000 samples: 0.65 % of the deviation at the shortest time, the model's N 0.5 %.
    EXPECT_NEAR(y.allan.ratio_dB(0), 20.0 * std::log10(1.5), 0.3);
    EXPECT_TRUE(y.standard_deviation.outside());
    EXPECT_TRUE(y.standard_deviation.stands_out);
    EXPECT_EQ(y.worst_number(), &y.standard_deviation);
    EXPECT_FALSE(comparison.axes.at(0).standard_deviation.outside());
}

TEST(Comparison, FindsALineThatNoAveragingTimeShows) {
    const SensorModel model = typical_mpu9250();
    SensorModel with_line = model;
    with_line.effects = {{"tone", {"z"}, {{"f_hz", 31.0}, {"amplitude_dps", 0.02}}, ""}};
    const Comparison comparison = against_model(recording_of(with_line, 6, 40'000), model);
    const AxisComparison& z = comparison.axes.at(2);
    ASSERT_EQ(z.worst(), &z.spectrum);
    EXPECT_NEAR(z.spectrum.gap.at, 31.0, 0.5);
    EXPECT_GT(z.spectrum.gap.dB, 1.0);
}

// Few samples far out, in pairs of both signs: hardly any power, and no skewness.
TEST(Comparison, FindsADistributionThatNoCurveShows) {
    const SensorModel model = typical_mpu9250();
    const auto recording = recording_of(model, 12);
    std::vector<double> rates = recording->find("gx")->values();
    const double sd = against_model(recording, model).axes.at(0).standard_deviation.recording;
    for (const std::size_t at : {2000U, 7000U}) {
        rates[at] += 8.0 * sd;
        rates[at + 2500] -= 8.0 * sd;
    }
    recording->columns[0] = {"gx", "rad/s", rates};
    const Comparison comparison = against_model(recording, model);
    const AxisComparison& x = comparison.axes.at(0);
    EXPECT_EQ(x.worst(), nullptr);
    ASSERT_EQ(x.worst_number(), &x.excess_kurtosis);
    // 4 of 12 000 samples at 8 standard deviations add 4 * 8^4 / 12 000 to the fourth moment.
    EXPECT_NEAR(x.excess_kurtosis.recording, 4.0 * 4096.0 / 12'000.0, 0.4);
    EXPECT_EQ(comparison.axes.at(1).worst_number(), nullptr);
}

TEST(ComparedNumber, OfNormalValuesStandsOutAsOftenAsWished) {
    constexpr double wished = 0.05;
    constexpr int trials = 4000;
    const RandomStream random(3, 77);
    int found = 0;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
        std::vector<double> simulated;
        for (std::uint64_t i = 0; i < 12; ++i) { simulated.push_back(5.0 + random.normal(trial * 13 + i)); }
        const auto same = [](double value) { return value; };
        found += compare_number(5.0 + random.normal(trial * 13 + 12), simulated, same, wished).stands_out;
    }
    const double expected = wished * trials;
    EXPECT_NEAR(found, expected, 4.0 * std::sqrt(expected));
}

TEST(ComparedNumber, WithoutAValueHasNoDistance) {
    const auto same = [](double value) { return value; };
    const std::vector<double> simulated{1.0, 2.0, 3.0};
    EXPECT_FALSE(compare_number(std::nan(""), simulated, same, 0.05).stands_out);
    EXPECT_FALSE(compare_number(9.0, {1.0, std::nan(""), 3.0}, same, 0.05).stands_out);
    EXPECT_TRUE(compare_number(9.0, {0.0, 0.0, 0.0}, same, 0.05).stands_out);
    EXPECT_FALSE(compare_number(0.0, {0.0, 0.0, 0.0}, same, 0.05).stands_out);
}

TEST(Comparison, FollowsTheRecordingsHoles) {
    const SensorModel model = typical_mpu9250();
    SensorModel losing = model;
    losing.effects = {{"dropped", {}, {{"per_hour", 600.0}}, ""}};
    const auto recording = recording_of(losing, 7, 30'000);
    ASSERT_GT(recording->segments.size(), 10U);
    const Comparison comparison = against_model(recording, model);
    EXPECT_EQ(comparison.samples, recording->rows());
    EXPECT_EQ(
        comparison.axes.at(0).allan.at.size(),
        axis_curves(*recording->find("gx"), recording->segments, recording->rate_hz).allan.points.size());
}

TEST(Comparison, IsTheSameBitsForAnyNumberOfThreads) {
    const SensorModel model = typical_mpu9250();
    const auto recording = recording_of(model, 8, 4000);
    ModelComparisonOptions options = quick();
    options.simulations = 12;
    options.threads = 1;
    const auto alone = compare_with_model(recording, model, "m", options);
    options.threads = 5;
    const auto together = compare_with_model(recording, model, "m", options);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(alone->axes[i].allan.hi, together->axes[i].allan.hi);
        EXPECT_EQ(alone->axes[i].spectrum.other, together->axes[i].spectrum.other);
        EXPECT_EQ(alone->axes[i].other_histogram.counts, together->axes[i].other_histogram.counts);
    }
    options.seed = 2;
    EXPECT_NE(compare_with_model(recording, model, "m", options)->axes[0].allan.hi, alone->axes[0].allan.hi);
}

TEST(Comparison, EndsEarlyWhenItIsToldTo) {
    ModelComparisonOptions options = quick();
    options.threads = 2;
    std::size_t told = 0;
    options.on_progress = [&](std::size_t done) { return (told = done) < 3; };
    EXPECT_FALSE(compare_with_model(recording_of(typical_mpu9250(), 9, 1000), typical_mpu9250(), "m", options)
                     .has_value());
    EXPECT_LE(told, 4U);  // one more may have been under way
}

// A turning table, known by a reference: what is compared is what the gyro adds to the motion.
TEST(Comparison, OfAMovingSensorIsOfWhatItShowsBeyondTheReference) {
    SensorModel model = typical_mpu9250();
    model.ref_noise_rad_s = 0.0;  // as the reference below
    const auto recording = recording_of(model, 11, 12'000);
    const double rate_hz = recording->rate_hz;
    std::vector<double> gyro_x = recording->find("gx")->values();
    std::vector<double> reference(gyro_x.size());
    for (std::size_t i = 0; i < gyro_x.size(); ++i) {
        reference[i] = 2.0 * std::sin(0.3 * static_cast<double>(i) / rate_hz);
        gyro_x[i] += 1.02 * reference[i];  // 2 % of scale error
    }
    reference[6000] = std::nan("");  // once not known
    recording->columns[0] = {"gx", "rad/s", gyro_x};
    recording->columns.push_back({"ref_x", "rad/s", reference});
    for (const char* name : {"ref_y", "ref_z"}) {
        recording->columns.push_back({name, "rad/s", std::vector<double>(gyro_x.size(), 0.0)});
    }
    const Comparison comparison = against_model(recording, model);
    EXPECT_TRUE(comparison.less_reference);
    const AxisComparison& x = comparison.axes.at(0);
    ASSERT_NE(x.worst(), nullptr);
    // 2 % of 2 rad/s: 0.028 rad/s of deviation, of which the motion itself has 70 times as much.
    EXPECT_NEAR(x.standard_deviation.recording, 0.02 * 2.0 / std::sqrt(2.0), 0.002);
    EXPECT_EQ(comparison.axes.at(1).worst(), nullptr);
}

TEST(Comparison, OfTwoRecordingsOfOneSensorFindsTheirDifferenceOnly) {
    SensorModel model = typical_mpu9250();
    const Comparison alike =
        compare_recordings(*recording_of(model, 1, 50'000), *recording_of(model, 2, 40'000));
    ASSERT_EQ(alike.axes.size(), 3U);
    for (const AxisComparison& axis : alike.axes) { EXPECT_EQ(axis.worst(), nullptr) << axis.axis; }
    const auto first = recording_of(model, 1, 50'000);
    model.axes[2].noise.N_rad_per_sqrt_s *= 0.8;
    const Comparison apart = compare_recordings(*first, *recording_of(model, 2, 40'000));
    ASSERT_NE(apart.axes.at(2).worst(), nullptr);
    EXPECT_NEAR(apart.axes.at(2).allan.ratio_dB(0), -20.0 * std::log10(0.8), 0.15);
    EXPECT_EQ(apart.axes.at(0).worst(), nullptr);
}

TEST(Comparison, OfTwoRecordingsLeavesOutWhatOnlyOneHas) {
    const auto first = recording_of(typical_mpu9250(), 1, 2000);
    auto second = recording_of(typical_mpu9250(), 2, 2000);
    std::erase_if(second->columns, [](const Column& column) { return column.name == "gy"; });
    const Comparison comparison = compare_recordings(*first, *second);
    EXPECT_EQ(comparison.axes.size(), 2U);
    ASSERT_EQ(comparison.warnings.size(), 1U);
    EXPECT_NE(comparison.warnings[0].find("y is left out"), std::string::npos);
}

TEST(Comparison, RefusesWhatCannotBeCompared) {
    const auto short_one = recording_of(typical_mpu9250(), 1, comparable_samples_min - 1);
    EXPECT_NE(comparison_refusal(*short_one)->find("63 samples"), std::string::npos);
    Recording counts = *recording_of(typical_mpu9250(), 1, 1000);
    EXPECT_EQ(comparison_refusal(counts), std::nullopt);
    counts.columns[0].unit = "lsb";
    EXPECT_NE(comparison_refusal(counts)->find("--lsb-dps"), std::string::npos);
    counts.columns.clear();
    EXPECT_NE(comparison_refusal(counts)->find("no angular rate"), std::string::npos);
}

TEST(BlockAverages, AverageAboutTheMeanAndLeaveHolesOpen) {
    const Column column{"gx", "rad/s", std::vector<double>{1, 2, 3, 4, 5, 6, 7, 9}};
    const std::vector<Segment> segments{{0, 4, 0}, {4, 4, 8}};
    const BlockAverages averages = block_averages(column, segments, 10.0, 6);
    ASSERT_EQ(averages.rate.size(), 6U);  // twelve slots, two each
    EXPECT_DOUBLE_EQ(averages.block_s, 0.2);
    EXPECT_DOUBLE_EQ(averages.middle_s(1), 0.3);
    const double mean = 37.0 / 8.0;
    EXPECT_DOUBLE_EQ(averages.rate[0], 1.5 - mean);
    EXPECT_TRUE(std::isnan(averages.rate[2]));
    EXPECT_TRUE(std::isnan(averages.rate[3]));
    EXPECT_DOUBLE_EQ(averages.rate[5], 8.0 - mean);
}

}  // namespace
}  // namespace gyrolog
