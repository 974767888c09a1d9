#include "analysis/diagnose/estimators/line.hpp"

#include <cmath>
#include <numeric>
#include <utility>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/steady_line.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/numerics/cosine_transform.hpp"
#include "analysis/simulate/counter_random.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr double rate_hz = 100.0;
constexpr double N_dps_per_sqrt_hz = 0.005;

// Half the ratio of the sinusoid's energy to the density of what it stands in, at a frequency of white noise.
double expected_gain_nats(const SensorModel& model, double amplitude_dps, std::uint64_t samples) {
    const double lsb_dps = model.lsb_rad_s * deg_per_rad;
    const double variance_dps2 = N_dps_per_sqrt_hz * N_dps_per_sqrt_hz * rate_hz + lsb_dps * lsb_dps / 12.0;
    return static_cast<double>(samples) * amplitude_dps * amplitude_dps / (4.0 * variance_dps2);
}

double turn_apart(double a_rad, double b_rad) { return std::fabs(std::remainder(a_rad - b_rad, 2.0 * pi)); }

TEST(LineShape, IsTheCosineTransformOfASinusoid) {
    constexpr std::size_t length = 240;
    CosineTransform transform(length);
    for (const double place : {0.7, 3.0, 41.5, 120.0, 200.123, 238.9}) {
        std::vector<double> cosine(length);
        std::vector<double> sine(length);
        for (std::size_t i = 0; i < length; ++i) {
            const double angle = pi * place / length * (static_cast<double>(i) + 0.5);
            cosine[i] = std::cos(angle);
            sine[i] = std::sin(angle);
        }
        transform.forward(cosine);
        transform.forward(sine);
        const LineShape shape(length, place);
        for (std::size_t k = 1; k < length; ++k) {
            EXPECT_NEAR(shape.at(k).cosine, cosine[k], 1e-9) << place << " " << k;
            EXPECT_NEAR(shape.at(k).sine, sine[k], 1e-9) << place << " " << k;
        }
    }
}

TEST(Line, FindsALineWithItsFrequencyAmplitudesAndPhases) {
    constexpr std::uint64_t samples = 90000;
    const SensorModel model = calibrated_sensor();
    SensorModel truth =
        with_effect(model, "tone", {{"f_hz", 22.3217}, {"amplitude_dps", 0.006}, {"phase_rad", 1.0}}, {"x"});
    truth =
        with_effect(truth, "tone", {{"f_hz", 22.3217}, {"amplitude_dps", 0.004}, {"phase_rad", -2.5}}, {"z"});
    const auto finding = found(make_line_estimator, "tone", recorded(truth, samples, 5), model);
    ASSERT_TRUE(finding);
    EXPECT_EQ(finding->where.axes, (std::vector<std::size_t>{0, 2}));
    ASSERT_EQ(finding->entries.size(), 2U);
    const double ideal =
        expected_gain_nats(model, 0.006, samples) + expected_gain_nats(model, 0.004, samples);
    // Half a non-central chi-square: five parameters were fitted.
    EXPECT_NEAR(finding->gain_nats, ideal + 2.5, 4.0 * std::sqrt(2.0 * ideal));
    const std::array<double, 2> amplitude_dps = {0.006, 0.004};
    const std::array<double, 2> phase_rad = {1.0, -2.5};
    for (std::size_t i = 0; i < 2; ++i) {
        auto& params = finding->entries[i].params;
        const auto& sd = finding->sd[i];
        EXPECT_NEAR(params.at("f_hz"), 22.3217, 4.0 * sd.at("f_hz"));
        EXPECT_NEAR(params.at("amplitude_dps"), amplitude_dps[i], 4.0 * sd.at("amplitude_dps"));
        EXPECT_LT(turn_apart(params.at("phase_rad"), phase_rad[i]), 4.0 * sd.at("phase_rad"));
        EXPECT_LT(sd.at("amplitude_dps"), 0.0004);
        EXPECT_LT(sd.at("f_hz"), 1e-4);
    }
    ASSERT_TRUE(finding->where.freq_hz);
    EXPECT_LT(finding->where.freq_hz->from, 22.3217);
    EXPECT_GT(finding->where.freq_hz->to, 22.3217);
}

TEST(Line, ReportsWhereALineAboveHalfTheRateAppears) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth = with_effect(model, "tone", {{"f_hz", 59.98}, {"amplitude_dps", 0.01}});
    const auto finding = found(make_line_estimator, "tone", recorded(truth, 30000, 6), model);
    ASSERT_TRUE(finding);
    EXPECT_NEAR(finding->entries.front().params.at("f_hz"), 40.02, 1e-3);
}

// With a delay and a scale in the model, which the line must come through as it was seen.
TEST(Line, LeavesNothingOfALineThatIsAddedToTheModel) {
    SensorModel model = calibrated_sensor();
    model.latency_s = 0.004;
    model = with_effect(model, "temp_scale", {{"per_C", 0.02}, {"reference_C", 15.0}});
    const SensorModel truth =
        with_effect(model, "tone", {{"f_hz", 31.4}, {"amplitude_dps", 0.05}, {"phase_rad", 0.3}}, {"y"});
    const auto recording = recorded(truth, 60000, 7);
    const auto finding = found(make_line_estimator, "tone", recording, model);
    ASSERT_TRUE(finding);
    ASSERT_EQ(finding->where.axes, std::vector<std::size_t>{1});
    EXPECT_GT(finding->evidence_nats, 500.0);
    EXPECT_NEAR(finding->entries.front().params.at("amplitude_dps"), 0.05, 0.002);
    const auto again = found(make_line_estimator, "tone", recording, with_cause(model, *finding));
    EXPECT_LT(evidence(again), 3.0);
}

// A clock of which the stamps tell acts no more on what is added; one that they hide does.
TEST(Line, LeavesNothingOfALineBesideAWrongClock) {
    for (const double in_stamps : {1.0, 0.0}) {
        const SensorModel model =
            with_effect(calibrated_sensor(), "clock_rate", {{"rel", 0.0016}, {"in_stamps", in_stamps}});
        const SensorModel truth =
            with_effect(model, "tone", {{"f_hz", 31.4}, {"amplitude_dps", 0.05}, {"phase_rad", 0.3}}, {"y"});
        const auto recording = recorded(truth, 60000, 7);
        const auto finding = found(make_line_estimator, "tone", recording, model);
        ASSERT_TRUE(finding);
        EXPECT_NEAR(finding->entries.front().params.at("amplitude_dps"), 0.05, 0.002) << in_stamps;
        EXPECT_NEAR(finding->entries.front().params.at("f_hz"), 31.4, 1e-3) << in_stamps;
        const auto again = found(make_line_estimator, "tone", recording, with_cause(model, *finding));
        EXPECT_LT(evidence(again), 3.0) << in_stamps;
    }
}

// Between the updates of a sensor that is polled too fast a line has images, and it is folded at the rate of
// updates: 60 Hz to 92.78 - 60.
TEST(Line, LeavesNoImageOfALineBesideABeatOfRepeats) {
    const SensorModel model = with_effect(calibrated_sensor(), "stale", {{"eps", 0.0722}});
    for (const double f_hz : {12.3, 60.0}) {
        const double seen_hz = f_hz < 46.39 ? f_hz : 92.78 - f_hz;
        const SensorModel truth =
            with_effect(model, "tone", {{"f_hz", f_hz}, {"amplitude_dps", 0.05}, {"phase_rad", 0.3}}, {"y"});
        const auto recording = recorded(truth, 60000, 7);
        const auto finding = found(make_line_estimator, "tone", recording, model);
        ASSERT_TRUE(finding) << f_hz;
        EXPECT_NEAR(finding->entries.front().params.at("f_hz"), seen_hz, 1e-3);
        EXPECT_NEAR(finding->entries.front().params.at("amplitude_dps"), 0.05, 0.002) << f_hz;
        const auto again = found(make_line_estimator, "tone", recording, with_cause(model, *finding));
        EXPECT_LT(evidence(again), 3.0) << f_hz;
    }
}

TEST(Line, TakesSeveralLinesOneAfterAnother) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth =
        with_effect(with_effect(model, "tone", {{"f_hz", 12.0}, {"amplitude_dps", 0.05}}), "tone",
                    {{"f_hz", 12.05}, {"amplitude_dps", 0.01}});
    const auto recording = recorded(truth, 60000, 8);
    const auto first = found(make_line_estimator, "tone", recording, model);
    ASSERT_TRUE(first);
    EXPECT_NEAR(first->entries.front().params.at("f_hz"), 12.0, 1e-3);
    const auto second = found(make_line_estimator, "tone", recording, with_cause(model, *first));
    ASSERT_TRUE(second);
    EXPECT_NEAR(second->entries.front().params.at("f_hz"), 12.05, 1e-3);
    EXPECT_GT(second->evidence_nats, 100.0);
}

TEST(Line, TakesNoBroadExcessForALine) {
    const SensorModel model = calibrated_sensor();
    const SensorModel louder = with_effect(model, "arw_scale", {{"factor", 1.4}});
    const SensorModel knee = with_effect(model, "gauss_markov", {{"sigma_dps", 0.02}, {"tau_s", 0.5}});
    const SensorModel filtered = with_effect(model, "lowpass", {{"order", 2.0}, {"fc_hz", 10.0}});
    const auto line_nats = [](const SensorModel& sensor, std::uint64_t seed, const SensorModel& known) {
        return evidence(found(make_line_estimator, "tone", recorded(sensor, 60000, seed), known));
    };
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        // The last: noise is what the model's filter took away.
        for (const auto& [sensor, known] : {std::pair(&louder, &model), std::pair(&knee, &model),
                                            std::pair(&filtered, &model), std::pair(&model, &filtered)}) {
            EXPECT_LT(line_nats(*sensor, seed, *known), 5.0) << seed;
            const SensorModel with_line =
                with_effect(*sensor, "tone", {{"amplitude_dps", 0.02}, {"f_hz", 4.7}, {"phase_rad", 1.0}});
            EXPECT_GT(line_nats(with_line, seed, *known), 20.0) << seed;
        }
    }
}

// Its phase walks by a turn in some 20 s: no steady line explains more than a small part of it.
TEST(Line, GivesALineThatWandersNoCredit) {
    constexpr std::uint64_t samples = 60000;
    constexpr double amplitude_dps = 0.02;
    const SensorModel model = calibrated_sensor();
    Recording wandering = *recorded(model, samples, 9);
    auto& counts = std::get<std::vector<std::int16_t>>(wandering.columns[0].data);
    const RandomStream noise(9, 77);
    double phase_rad = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        phase_rad += 2.0 * pi * 17.0 / rate_hz + 0.14 * noise.normal(i);
        const double value = static_cast<double>(counts[i]) +
                             amplitude_dps * rad_per_deg / model.lsb_rad_s * std::sin(phase_rad);
        counts[i] = static_cast<std::int16_t>(std::lround(value));
    }
    const auto finding =
        found(make_line_estimator, "tone", std::make_shared<const Recording>(wandering), model);
    EXPECT_LT(evidence(finding), 0.02 * expected_gain_nats(model, amplitude_dps, samples));
}

// An axis of three has it or has it not; of one axis there is nothing to choose.
TEST(Line, PaysForTheChoiceOfAxesWhereThereIsOne) {
    const SensorModel model = calibrated_sensor();
    const SensorModel sensor =
        with_effect(model, "tone", {{"amplitude_dps", 0.02}, {"f_hz", 17.3}, {"phase_rad", 1.0}}, {"x"});
    const Recording whole = *recorded(sensor, 8192, 12);
    Recording alone = whole;
    alone.columns.erase(alone.columns.begin() + 1, alone.columns.begin() + 3);
    const auto of_three = found(make_line_estimator, "tone", std::make_shared<const Recording>(whole), model);
    const auto of_one = found(make_line_estimator, "tone", std::make_shared<const Recording>(alone), model);
    ASSERT_TRUE(of_three && of_one);
    ASSERT_EQ(of_three->where.axes, std::vector<std::size_t>{0});
    EXPECT_NEAR(of_one->gain_nats, of_three->gain_nats, 0.05);
    EXPECT_NEAR(of_one->evidence_nats - of_three->evidence_nats, std::log(2.0), 0.1);
}

TEST(Line, AnswersForOneDeadAxisAndFewSamples) {
    const SensorModel model = calibrated_sensor();
    EXPECT_LT(evidence(found(make_line_estimator, "tone", few_samples_with_a_dead_axis(model, 10), model)),
              3.0);
    const SensorModel sensor =
        with_effect(model, "tone", {{"amplitude_dps", 0.05}, {"f_hz", 17.3}, {"phase_rad", 1.0}}, {"z"});
    const auto finding = found(make_line_estimator, "tone", few_samples_with_a_dead_axis(sensor, 10), model);
    ASSERT_TRUE(finding);
    EXPECT_TRUE(std::isfinite(finding->evidence_nats));
    EXPECT_GT(finding->evidence_nats, 20.0);
    EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{2});
}

}  // namespace
}  // namespace gyrolog
