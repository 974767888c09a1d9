// Over many seeds: how often noise alone is taken for a line, a jump or a telegraph, and whether stated
// standard deviations hold.
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/compare/model_draw.hpp"
#include "analysis/diagnose/estimators/bias_step.hpp"
#include "analysis/diagnose/estimators/line.hpp"
#include "analysis/diagnose/estimators/random_telegraph.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

struct Method {
    EstimatorMaker make;
    const char* effect;
};

class NoiseAlone : public testing::TestWithParam<Method> {};

// A Bayes factor of e^x comes from noise alone with a probability of e^-x at most.
TEST_P(NoiseAlone, SeldomHasEvidence) {
    constexpr int recordings = 300;
    const SensorModel model = calibrated_sensor();
    const auto prediction = prediction_of(recorded(model, 8192, 1), model);
    const MadeEstimator made = GetParam().make(*find_effect(GetParam().effect), prediction);
    int above_1 = 0;
    int above_3 = 0;
    for (int i = 0; i < recordings; ++i) {
        SimulationRequest request;
        request.like = prediction->shared_world();
        request.seed = 100 + static_cast<std::uint64_t>(i);
        const SensorModel truth = draw_within_uncertainty(model, request.seed);
        const auto recording = std::make_shared<const Recording>(simulate_recording(truth, request));
        const double nats = evidence(made.estimator->find(Observation(prediction, recording, 1)));
        above_1 += nats > 1.0 ? 1 : 0;
        above_3 += nats > 3.0 ? 1 : 0;
    }
    // The bound is not reached, since most of the priors' mass lies where an effect would be seen at once.
    EXPECT_LE(above_1, recordings * 0.08);
    EXPECT_LE(above_3, recordings * 0.02);
}

INSTANTIATE_TEST_SUITE_P(OfLinesAndLevels, NoiseAlone,
                         testing::Values(Method{make_line_estimator, "tone"},
                                         Method{make_bias_step_estimator, "bias_step"},
                                         Method{make_random_telegraph_estimator, "rtn"}),
                         [](const auto& parameter) { return std::string(parameter.param.effect); });

// How many of the fits of one parameter are within two standard deviations of the truth.
int within_two_sd(const Method& method, const SensorModel& model, const SensorModel& truth,
                  std::uint64_t samples, const char* param, double value, int seeds) {
    int within = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto finding = found(method.make, method.effect,
                                   recorded(truth, samples, static_cast<std::uint64_t>(seed)), model);
        if (!finding || finding->entries.empty()) { continue; }
        const double off = finding->entries.front().params.at(param) - value;
        within += std::fabs(off) < 2.0 * finding->sd.front().at(param) ? 1 : 0;
    }
    return within;
}

// 95 % are; of 40 fewer than 33 once in 5000 times.
constexpr int seeds_of_coverage = 40;
constexpr int within_min = 33;

TEST(StandardDeviations, OfALineHold) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth =
        with_effect(model, "tone", {{"f_hz", 22.3}, {"amplitude_dps", 0.006}, {"phase_rad", 0.4}}, {"x"});
    const Method line{make_line_estimator, "tone"};
    EXPECT_GE(within_two_sd(line, model, truth, 16384, "f_hz", 22.3, seeds_of_coverage), within_min);
    EXPECT_GE(within_two_sd(line, model, truth, 16384, "amplitude_dps", 0.006, seeds_of_coverage),
              within_min);
    EXPECT_GE(within_two_sd(line, model, truth, 16384, "phase_rad", 0.4, seeds_of_coverage), within_min);
}

TEST(StandardDeviations, OfAJumpHold) {
    const SensorModel model = calibrated_sensor();
    const SensorModel truth = with_effect(model, "bias_step", {{"step_dps", 0.03}, {"at_s", 70.0}}, {"x"});
    const Method step{make_bias_step_estimator, "bias_step"};
    EXPECT_GE(within_two_sd(step, model, truth, 16384, "step_dps", 0.03, seeds_of_coverage), within_min);
    EXPECT_GE(within_two_sd(step, model, truth, 16384, "at_s", 70.0, seeds_of_coverage), within_min);
}

}  // namespace
}  // namespace gyrolog
