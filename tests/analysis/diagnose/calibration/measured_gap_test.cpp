#include "analysis/diagnose/calibration/measured_gap.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/diagnose/calibration/half_fit.hpp"
#include "analysis/diagnose/estimators/catalogue.hpp"
#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/numerics/square.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t samples = 16'000;

Finding finding_of(const std::string& effect, const SensorModel& model,
                   const std::shared_ptr<const Recording>& recording) {
    const auto prediction = prediction_of(recording, model);
    const MadeEstimator made = make_estimator(*find_effect(effect), prediction);
    return made.estimator->find(Observation(prediction, recording, 1)).value();
}

GapTrial trial_of(const SensorModel& model, const std::shared_ptr<const Recording>& recording,
                  std::vector<Finding> causes) {
    const auto prediction = prediction_of(recording, model);
    GapTrial trial{recording, {}, model, std::move(causes), 0.0, 0.0};
    for (const auto& [fitted, judging] :
         {std::pair(Half::first, Half::second), std::pair(Half::second, Half::first)}) {
        trial.folds.push_back({prediction->of_half(judging),
                               fitted_to_half(prediction->of_half(fitted), recording, trial.causes, 1)});
    }
    return trial;
}

MeasuredGap measured(const GapTrial& trial) {
    MeasuredGapOptions options;
    options.simulations = 24;
    options.paired_simulations = 4;
    return measure_gap(trial, options).value();
}

TEST(Halves, MakeUpTheWhole) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(model, samples, 50);
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

// Of two causes each returns what is its own, and both together close the gap.
TEST(MeasuredGap, IsClosedByTheCausesThatAreThere) {
    const SensorModel model = calibrated_sensor();
    SensorModel sensor = with_effect(model, "arw_scale", {{"factor", 1.3}}, {"x"});
    sensor = with_effect(sensor, "bias_step", {{"at_s", 71.0}, {"step_dps", 0.03}}, {"y"});
    const auto recording = recorded(sensor, samples, 51);
    const MeasuredGap gap = measured(
        trial_of(model, recording,
                 {finding_of("arw_scale", model, recording), finding_of("bias_step", model, recording)}));
    EXPECT_GT(gap.before.value, 3.0);
    EXPECT_LT(gap.named.value, 1.5);
    EXPECT_GT(gap.shrink.value, 0.95);
    EXPECT_LE(gap.shrink.lo, gap.shrink.value);
    EXPECT_GE(gap.shrink.hi, gap.shrink.value);
    ASSERT_EQ(gap.shares.size(), 2U);
    for (const Share& share : gap.shares) {
        EXPECT_GT(share.value, 0.05);
        EXPECT_LT(share.value, 0.95);
    }
    EXPECT_NEAR(gap.shares[0].value + gap.shares[1].value, 1.0, 0.1);
}

// One that is taken from another recording, where it is, makes this one's gap larger.
TEST(MeasuredGap, GrowsByACauseThatIsNotThere) {
    const SensorModel model = calibrated_sensor();
    const SensorModel stepping = with_effect(model, "bias_step", {{"at_s", 71.0}, {"step_dps", 0.03}}, {"y"});
    const Finding elsewhere = finding_of("bias_step", model, recorded(stepping, samples, 52));
    GapTrial trial = trial_of(
        model, recorded(with_effect(model, "arw_scale", {{"factor", 1.3}}, {"x"}), samples, 53), {elsewhere});
    for (Fold& fold : trial.folds) { fold.causes = {elsewhere}; }
    const MeasuredGap gap = measured(trial);
    EXPECT_GT(gap.named.value, gap.before.value);
    EXPECT_LT(gap.shrink.value, 0.0);
    EXPECT_LT(gap.returning_nats.front(), -10.0);
}

// The model that was given is held against its own simulations. Those of the corrected one have the tails,
// too.
TEST(MeasuredGap, HoldsEveryModelAgainstItsOwnSimulations) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(with_effect(model, "heavy_tail", {{"nu", 6.0}}, {}), samples, 55);
    const MeasuredGap gap =
        measured(trial_of(model, recording, {finding_of("heavy_tail", model, recording)}));
    EXPECT_GT(gap.before.value, 2.5);
    EXPECT_LT(gap.named.value, 1.5);
    EXPECT_GT(gap.shrink.value, 0.9);
}

// White noise of another size is told by the log likelihood ratio n (r - 1 - ln r) / 2, r the ratio of the
// variances. The surprisal sums measures that see the same, so more of it returns. Each point says little: 33
// nats return on average where no direction is looked along, which adds the ratio itself, 60 in all.
TEST(MeasuredGap, SeesAWeakCauseByItsDirection) {
    constexpr double factor = 1.04;
    constexpr double ratio = factor * factor;
    const double told_nats = 0.5 * static_cast<double>(samples) * (ratio - 1.0 - std::log(ratio));
    constexpr std::uint64_t recordings = 8;
    SensorModel model = calibrated_sensor();
    model.sd_rel = {{"N", 1e-4}, {"B", 1e-4}, {"K", 1e-4}};
    double mean_nats = 0.0;
    for (std::uint64_t seed = 56; seed < 56 + recordings; ++seed) {
        const auto recording =
            recorded(with_effect(model, "arw_scale", {{"factor", factor}}, {"x"}), samples, seed);
        const Finding finding = finding_of("arw_scale", model, recording);
        mean_nats += measured(trial_of(model, recording, {finding})).returning_nats.front() / recordings;
    }
    EXPECT_GT(mean_nats, 2.0 * told_nats);
}

// The rate changes within a dead zone, and simulations that have it all say the same there: what they scatter
// by is no scale for a recording without it.
TEST(MeasuredGap, TakesNoScaleFromWhereSimulationsDoNotDiffer) {
    SensorModel model = calibrated_sensor();
    model.ref_noise_rad_s = 0.02 * rad_per_deg;
    model.sd_abs = {{"M", 2e-4}, {"latency_s", 1e-4}, {"rate_rel", 5e-5}};
    const auto world = world_turning([](double t_s) {
        const double peak_rad_s = 0.5 * std::max(0.0, std::sin(2.0 * M_PI * t_s / 40.0));
        return Vector3{peak_rad_s * std::sin(2.0 * M_PI * t_s / 3.7),
                       peak_rad_s * std::sin(2.0 * M_PI * t_s / 2.3),
                       peak_rad_s * std::sin(2.0 * M_PI * t_s / 1.7)};
    });
    const auto recording = recorded(model, samples, 58, world);
    const SensorModel dead =
        with_effect(model, "dead_zone", {{"width_dps", 0.07}, {"jump", 1.0}}, {"x", "y", "z"});
    const Finding dead_zone = finding_of("dead_zone", model, recorded(dead, samples, 57, world));
    GapTrial trial = trial_of(model, recording, {dead_zone});
    for (Fold& fold : trial.folds) { fold.causes = {dead_zone}; }
    EXPECT_LT(measured(trial).before.value, 2.0);
}

// A change of noise in the coefficients of one half alone, which no law of nature would make: what either
// half says is wrong for the other.
TEST(MeasuredGap, OfWhatOnlyOneHalfHasIsNotClosed) {
    SensorModel model = calibrated_sensor();
    model.sd_rel = {{"N", 1e-4}, {"B", 1e-4}, {"K", 1e-4}};
    Recording recording = *recorded(model, samples, 54);
    CosineTransform transform(recording.rows());
    for (Column& column : recording.columns) {
        if (column.name != "gx") { continue; }
        std::vector<double> values = column.values();
        transform.forward(values);
        for (std::size_t k = 1; k < values.size(); ++k) {
            if (has_coefficient(Half::first, k)) { values[k] *= 1.3; }
        }
        transform.inverse(values);
        column.data = values;
        column.scale = 1.0;
        column.offset = 0.0;
    }
    const auto changed = std::make_shared<const Recording>(std::move(recording));
    const MeasuredGap gap = measured(trial_of(model, changed, {finding_of("arw_scale", model, changed)}));
    EXPECT_LT(gap.shrink.value, 0.3);
}

// The square of the gap is 1 on average where the recording is a simulation of the model.
TEST(MeasuredGap, OfASimulationIsTheFloor) {
    constexpr int recordings = 24;
    SensorModel model = calibrated_sensor();
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < recordings; ++i) {
        const auto recording = recorded(model, samples, 600 + static_cast<std::uint64_t>(i));
        const MeasuredGap gap = measured(trial_of(model, recording, {}));
        EXPECT_EQ(gap.before.value, gap.named.value);
        // What is told closes by what the distances say, however small the gap is.
        ASSERT_GT(gap.judged.value, 1.0);
        const double closed = 1.0 - (square(gap.named.value) - 1.0) / (square(gap.judged.value) - 1.0);
        EXPECT_NEAR(gap.shrink.value, std::min(closed, 1.0), 1e-9);
        sum += square(gap.before.value);
        squares += square(square(gap.before.value));
    }
    const double mean = sum / recordings;
    const double sd = std::sqrt((squares / recordings - mean * mean) / (recordings - 1));
    EXPECT_NEAR(mean, 1.0, 4.0 * sd);
    EXPECT_LT(sd, 0.1);
}

}  // namespace
}  // namespace gyrolog
