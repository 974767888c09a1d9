// Halves of a recording share nothing, and what is fitted to one is right for the other where the effect is
// in both.

#include "analysis/diagnose/calibration/split_half_validation.hpp"

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/numerics/cosine_transform.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

TEST(Halves, TogetherAreTheWhole) {
    const std::size_t length = 36000;
    double bins = 0.0;
    double slots = 0.0;
    for (const Half half : {Half::first, Half::second}) {
        for (const SpectralBin& bin : spectral_bins(length, 100.0, half)) {
            EXPECT_GT(bin.count(), 0.0);
            bins += bin.count();
        }
        for (std::size_t slot = 0; slot < length; ++slot) { slots += has_slot(half, slot, length); }
    }
    EXPECT_EQ(bins, static_cast<double>(length - 1));
    EXPECT_EQ(slots, static_cast<double>(length));
}

TEST(Halves, ShareThePowerOfTheWhole) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(model, 36000, 50);
    const auto whole = prediction_of(recording, model);
    const auto energy = [&](Half half) {
        const Observation seen(whole->of_half(half), recording, 1);
        double sum = 0.0;
        for (std::size_t i = 0; i < seen.axis(0).power.size(); ++i) {
            sum += seen.axis(0).power[i] * seen.prediction().bins()[i].count();
        }
        return sum;
    };
    const double all = energy(Half::both);
    EXPECT_NEAR(energy(Half::first) + energy(Half::second), all, 1e-9 * all);
}

struct Case {
    std::string effect;
    std::map<std::string, double> params;
};

SplitHalfResult checked(const std::shared_ptr<const Recording>& recording, const SensorModel& model,
                        const std::string& effect) {
    const auto prediction = prediction_of(recording, model);
    const MadeEstimator made = make_estimator(*find_effect(effect), prediction);
    const std::optional<Finding> finding = made.estimator->find(Observation(prediction, recording, 1));
    if (!finding) {
        ADD_FAILURE() << "no finding of " << effect;
        return {};
    }
    return validate_by_halves(prediction, recording, {*finding}, 1, 2);
}

TEST(SplitHalfValidation, LeavesNothingOfAnEffectThatBothHalvesHave) {
    const Case cases[] = {{"arw_scale", {{"factor", 1.1}}},
                          {"gauss_markov", {{"sigma_dps", 0.01}, {"tau_s", 4.0}}},
                          {"bias_step", {{"at_s", 131.0}, {"step_dps", 0.02}}},
                          {"variance_change", {{"at_s", 201.0}, {"factor", 1.2}, {"ramp_s", 0.0}}},
                          {"heavy_tail", {{"nu", 6.0}}}};
    int checks = 0;
    int left = 0;
    for (const Case& each : cases) {
        for (std::uint64_t seed = 60; seed < 65; ++seed) {
            const SensorModel model = calibrated_sensor();
            const auto recording = recorded(with_effect(model, each.effect, each.params, {"x"}), 36000, seed);
            const SplitHalfResult result = checked(recording, model, each.effect);
            EXPECT_EQ(result.judged, std::vector<std::string>{each.effect}) << seed;
            ++checks;
            left += result.excess_nats > 0.0;
        }
    }
    // Evidence of 3 nats is found by chance with a probability of at most exp(-3), in either half, and hardly
    // ever beyond three standard deviations of what the fits' own errors make.
    EXPECT_EQ(checks, 25);
    EXPECT_LE(left, 2);
}

// A change of noise in the coefficients of one half alone, which no law of nature would make.
TEST(SplitHalfValidation, CountsWhatOnlyOneHalfHas) {
    SensorModel model = calibrated_sensor();
    model.sd_rel = {{"N", 1e-4}, {"B", 1e-4}, {"K", 1e-4}};
    Recording recording = *recorded(model, 36000, 70);
    CosineTransform transform(recording.rows());
    std::vector<double> values = recording.find("gx")->values();
    transform.forward(values);
    for (std::size_t k = 1; k < values.size(); ++k) {
        if (has_coefficient(Half::first, k)) { values[k] *= 1.2; }
    }
    transform.inverse(values);
    for (Column& column : recording.columns) {
        if (column.name != "gx") { continue; }
        column.data = values;
        column.scale = 1.0;
        column.offset = 0.0;
    }
    const auto changed = std::make_shared<const Recording>(std::move(recording));
    const SplitHalfResult result = checked(changed, model, "arw_scale");
    EXPECT_EQ(result.judged, std::vector<std::string>{"arw_scale"});
    // 18 000 squares of ratio 1 / 1.44: 1/2 n (x - 1 - ln x).
    const double expected_nats = 0.5 * 18000.0 * (1.0 / 1.44 - 1.0 + std::log(1.44));
    EXPECT_NEAR(result.excess_nats, expected_nats, 0.2 * expected_nats);
    EXPECT_GT(result.evidence_left_nats, 0.7 * expected_nats);
}

TEST(SplitHalfValidation, DoesNotJudgeWhatIsInFewPlaces) {
    const SensorModel model = calibrated_sensor();
    const auto recording =
        recorded(with_effect(model, "dropped", {{"per_hour", 200.0}, {"longest", 4.0}}, {}), 36000, 71);
    EXPECT_TRUE(checked(recording, model, "dropped").judged.empty());
    const auto drifting =
        recorded(with_effect(model, "rate_ramp", {{"ramp_dps_per_s", 1e-3}}, {}), 36000, 72);
    EXPECT_TRUE(checked(drifting, model, "rate_ramp").judged.empty());
}

}  // namespace
}  // namespace gyrolog
