#include "analysis/diagnose/selection/cause_probability.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/diagnose/decision_options.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

Finding finding(const char* effect, double evidence_nats) {
    Finding finding;
    finding.effect = effect;
    finding.evidence_nats = evidence_nats;
    return finding;
}

FoundCause found(double evidence_nats, const std::vector<Finding>& rivals) {
    return {finding("temp_lag", evidence_nats), rivals};
}

TEST(CauseProbability, ComparesWithRivalsAndWithNothing) {
    const Cause alone = with_probability(found(50.0, {}), {}, 3.0, {});
    EXPECT_NEAR(alone.score, 1.0 / (1.0 + std::exp(-3.0)), 1e-12);
    EXPECT_THAT(alone.tie_group, SizeIs(0));
    const Cause one_of_two = with_probability(found(50.0, {finding("temp_linear", 49.0)}), {}, 40.0, {});
    EXPECT_NEAR(one_of_two.score, 1.0 / (1.0 + std::exp(-1.0)), 1e-12);
    ASSERT_THAT(one_of_two.tie_group, SizeIs(2));
    EXPECT_NEAR(probability_of_tie(one_of_two), 1.0, 1e-12);
    EXPECT_THAT(deciding_recording(one_of_two), HasSubstr("to tell temp_lag from temp_linear: "));
}

// One length, that which the evidence asks for, in a unit that one can read.
TEST(CauseProbability, AsksForALengthThatFollowsFromTheEvidence) {
    const auto proposal = [](const char* effect, double behind_nats, double duration_s) {
        const FoundCause found{finding(effect, 50.0), {finding("gauss_markov", 50.0 - behind_nats)}};
        Cause cause = with_probability(found, {}, 40.0, {});
        state_deciding_length(cause, duration_s);
        EXPECT_EQ(deciding_recording(cause),
                  "to tell " + std::string(effect) + " from gauss_markov: " + cause.decided_by);
        return cause.decided_by;
    };
    const int times = static_cast<int>(std::ceil(decisions.certain_nats()));
    EXPECT_EQ(proposal("flicker_missing", 1.0, 600.0),
              "a still recording of " + std::to_string(10 * times) + " min or more at a steady temperature");
    EXPECT_THAT(proposal("flicker_missing", 1.0, 3.0 * 3600.0), HasSubstr(" of 24 h or more"));
    EXPECT_THAT(proposal("rtn", 0.0, 86400.0), HasSubstr(" days or more: two levels then"));
    EXPECT_EQ(proposal("temp_lag", 1.0, 600.0), "one sweep of the temperature up and down by 5 degC or more");
}

// What is as strong beside all causes is a further cause, not a rival.
TEST(CauseProbability, ComparesWithWhatARivalGainsByTheAbsence) {
    const SensorModel model = calibrated_sensor();
    CauseSelection selection;
    selection.last.prediction = prediction_of(recorded(model, 2000, 1), model);
    selection.last.findings = {std::nullopt, finding("temp_linear", 60.0)};
    const FoundCause cause = found(50.0, {finding("temp_linear", 70.0)});
    EXPECT_GT(with_probability(cause, selection, 40.0, {}).score, 0.99);
    EXPECT_LT(with_probability(cause, {}, 40.0, {}).score, 0.01);
    selection.null_bias = {{{"temp_linear", 55.0}}, "tone", {}};
    EXPECT_LT(with_probability(cause, selection, 40.0, {}).score, 0.01);
}

TEST(CauseProbability, IsSmallWhereAShapeWithoutANameIsBetter) {
    const BetterShape shape{"A course", {"temp_lag"}, 12.0};
    EXPECT_LT(with_probability(found(50.0, {}), {}, 40.0, shape).score, 1e-5);
    const BetterShape in_place_of_another{"A course", {"tone"}, 12.0};
    EXPECT_GT(with_probability(found(50.0, {}), {}, 40.0, in_place_of_another).score, 0.99);
}

// Without the cause the gap is smaller on data that the fit did not use.
TEST(CauseProbability, IsSmallWhereNothingDoesBetter) {
    EXPECT_LT(with_probability(found(50.0, {}), {}, -5.0, {}).score, 0.01);
}

TEST(CauseProbability, OfWhatIsCountedIsThatOfItsOwnEvidence) {
    EXPECT_GT(with_probability({finding("stale", 50.0), {}}, {}, -5.0, {}).score, 0.99);
}

}  // namespace
}  // namespace gyrolog
