// A line, a parabola and a cubic over the temperature: each is itself, and none where there is none.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/mean_response.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t half_an_hour = 180'000;
constexpr std::array curves = {"temp_linear", "temp_quadratic", "temp_cubic"};

// Up and down by 12 degC on either side of 27 degC, within half an hour.
std::shared_ptr<const World> swept() {
    auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = [](double t_s) { return 27.0 + 12.0 * triangle(t_s / 1800.0); };
    return world;
}

std::optional<Finding> finding_of(const std::vector<std::optional<Finding>>& findings, const char* effect) {
    const auto is_it = [&](const std::optional<Finding>& one) { return one && one->effect == effect; };
    const auto place = std::ranges::find_if(findings, is_it);
    return place == findings.end() ? std::nullopt : *place;
}

std::map<std::string, double> evidences(const SensorModel& sensor, std::uint64_t seed) {
    const auto recording = recorded(sensor, half_an_hour, seed, swept());
    std::map<std::string, double> nats;
    for (const char* curve : curves) {
        nats[curve] = evidence(found(make_mean_response_estimator, curve, recording, calibrated_sensor()));
    }
    return nats;
}

TEST(TemperatureCurve, CubicIsFoundWithItsCoefficients) {
    const std::map<std::string, double> put_in = {
        {"c1_dps_per_C", 0.004}, {"c2_dps_per_C2", -3e-4}, {"c3_dps_per_C3", 4e-5}};
    const auto recording =
        recorded(with_effect(calibrated_sensor(), "temp_cubic", put_in, {"y"}), half_an_hour, 61, swept());
    const auto finding = found(make_mean_response_estimator, "temp_cubic", recording, calibrated_sensor());
    ASSERT_TRUE(finding);
    EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{1});
    for (const auto& [name, value] : put_in) {
        EXPECT_NEAR(finding->entries.front().params.at(name), value, 4.0 * finding->sd.front().at(name))
            << name;
        EXPECT_LT(finding->sd.front().at(name), 0.3 * std::fabs(value)) << name;
    }
}

// A lag of hours is half an hour's integral of the temperature, as every longer one is.
TEST(TemperatureCurve, LagsByNoMoreThanTheRecordingIsLong) {
    const SensorModel sensor =
        with_effect(calibrated_sensor(), "temp_lag", {{"c1_dps_per_C", 0.2}, {"tau_s", 18'000.0}}, {"x"});
    const auto recording = recorded(sensor, half_an_hour, 62, swept());
    const auto finding = found(make_mean_response_estimator, "temp_lag", recording, calibrated_sensor());
    ASSERT_TRUE(finding);
    EXPECT_GT(evidence(finding), 20.0);
    EXPECT_LE(finding->entries.front().params.at("tau_s"), 1800.0 * (1.0 + 1e-9));
}

// The weakest curve of each order that is clearly one: its last term alone has some tens of nats.
TEST(TemperatureCurve, OfEachOrderIsItself) {
    const std::array<std::map<std::string, double>, 3> params = {
        std::map<std::string, double>{{"c1_dps_per_C", 0.002}},
        {{"c1_dps_per_C", 0.002}, {"c2_dps_per_C2", 2e-4}},
        {{"c1_dps_per_C", 0.002}, {"c2_dps_per_C2", 2e-4}, {"c3_dps_per_C3", 3e-5}}};
    for (std::size_t order = 0; order < curves.size(); ++order) {
        for (std::uint64_t seed = 1; seed <= seeds_asked(2); ++seed) {
            const SensorModel sensor =
                with_effect(calibrated_sensor(), curves.at(order), params.at(order), {"x"});
            const std::map<std::string, double> nats = evidences(sensor, 100 * order + seed);
            const auto best = std::ranges::max_element(nats, {}, [](const auto& one) { return one.second; });
            EXPECT_EQ(best->first, curves.at(order)) << seed << " " << testing::PrintToString(nats);
            EXPECT_GT(best->second, 20.0) << seed;
        }
    }
}

// A walk that was found first has taken up the course, and has no size of its own beside it: however large it
// was, the course's coefficient is as certain as without it.
TEST(TemperatureCurve, IsFittedTogetherWithTheWalkThatStoodForIt) {
    constexpr double c1_dps_per_C = 0.002;
    SensorModel model = calibrated_sensor();
    for (AxisModel& axis : model.axes) { axis.noise = {.N_rad_per_sqrt_s = axis.noise.N_rad_per_sqrt_s}; }
    model.sd_rel = {{"N", 0.005}};
    const auto recording =
        recorded(with_effect(model, "temp_linear", {{"c1_dps_per_C", c1_dps_per_C}}, {"x"}), half_an_hour, 63,
                 swept());
    const Hypotheses first = examine(prediction_of(recording, model), recording, 1, 1);
    auto walk = finding_of(first.findings, "rrw_missing");
    ASSERT_TRUE(walk);
    ASSERT_EQ(walk->where.axes, std::vector<std::size_t>{0});
    walk->entries.front().params.at("K_dps_sqrt_hz") *= 4.0;
    const auto beside =
        found(make_mean_response_estimator, "temp_linear", recording, with_open_cause(model, *walk));
    ASSERT_TRUE(beside);
    EXPECT_EQ(beside->where.axes, std::vector<std::size_t>{0});
    EXPECT_NEAR(beside->entries.front().params.at("c1_dps_per_C"), c1_dps_per_C, 0.2 * c1_dps_per_C);
    const auto as_it_was =
        found(make_mean_response_estimator, "temp_linear", recording, with_cause(model, *walk));
    ASSERT_TRUE(as_it_was);
    const auto sd = [](const Finding& finding) { return finding.sd.front().at("c1_dps_per_C"); };
    EXPECT_LT(sd(*beside), 0.3 * sd(*as_it_was));
    EXPECT_GT(beside->evidence_nats, 10.0);
}

// Within half a degree on one side of the reference a line and a parabola are one curve: each coefficient of
// the parabola is hardly known, and its curve as well as the line's. The simpler one stands first where the
// other is not ahead, the other beside it.
TEST(TemperatureCurve, ThatIsALineOverANarrowRangeIsALine) {
    auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = [](double t_s) { return 25.4 + 0.25 * triangle(t_s / 1800.0); };
    int lines = 0;
    for (std::uint64_t seed = 1; seed <= seeds_asked(4); ++seed) {
        const SensorModel sensor =
            with_effect(calibrated_sensor(), "temp_linear", {{"c1_dps_per_C", 0.06}}, {"x"});
        const auto recording = recorded(sensor, half_an_hour, 300 + seed, world);
        const Hypotheses first = examine(prediction_of(recording, calibrated_sensor()), recording, 1, 1);
        const std::optional<CauseSelection> selection = select_causes(first, recording, {});
        ASSERT_TRUE(selection);
        ASSERT_EQ(selection->causes.size(), 1U) << seed;
        const FoundCause& cause = selection->causes.front();
        const bool is_line = cause.finding.effect == "temp_linear";
        lines += is_line;
        const char* other = is_line ? "temp_quadratic" : "temp_linear";
        const auto rival = std::ranges::find(cause.rivals, other, &Finding::effect);
        ASSERT_NE(rival, cause.rivals.end()) << seed << " " << cause.finding.effect;
        EXPECT_NEAR(rival->evidence_nats, cause.finding.evidence_nats, 3.0) << seed;
        if (!is_line) { EXPECT_GT(cause.finding.evidence_nats, rival->evidence_nats) << seed; }
    }
    EXPECT_GE(2 * lines, static_cast<int>(seeds_asked(4)));
}

TEST(TemperatureCurve, IsNoneWhereNothingFollowsTheTemperature) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        for (const auto& [curve, nats] : evidences(calibrated_sensor(), 200 + seed)) {
            EXPECT_LT(nats, 3.0) << curve << " " << seed;
        }
    }
}

TEST(TemperatureCurve, OfThirdOrderIsOneCause) {
    const SensorModel model = calibrated_sensor();
    const SensorModel sensor = with_effect(
        model, "temp_cubic", {{"c1_dps_per_C", 0.002}, {"c2_dps_per_C2", 2e-4}, {"c3_dps_per_C3", 5e-5}});
    const auto recording = recorded(sensor, half_an_hour, 62, swept());
    const Hypotheses first = examine(prediction_of(recording, model), recording, 1, 1);
    const auto selection = select_causes(first, recording, {});
    ASSERT_TRUE(selection);
    ASSERT_EQ(selection->causes.size(), 1U);
    EXPECT_EQ(selection->causes.front().finding.effect, "temp_cubic");
}

}  // namespace
}  // namespace gyrolog
