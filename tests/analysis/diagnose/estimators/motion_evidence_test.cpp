// Effects of a moving sensor, whose gains the model knows within an uncertainty and whose reference is noisy.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/line.hpp"
#include "analysis/diagnose/estimators/mean_response.hpp"
#include "analysis/diagnose/estimators/saturation.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/likelihood/denoised_reference.hpp"
#include "analysis/diagnose/selection/forward_selection.hpp"
#include "analysis/numerics/square.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

// Rest and tumbling in turns of a minute, one growing out of the other.
double peak_rad_s(double t_s) {
    const double moving_s = std::fmod(t_s, 120.0) - 60.0;
    return moving_s < 0.0 ? 0.0 : 2.0 * std::pow(std::sin(pi * moving_s / 60.0), 2.0);
}

double world_rate_x_rad_s(double t_s) { return peak_rad_s(t_s) * std::sin(2.0 * pi * t_s / 3.7); }

std::shared_ptr<const World> world_with_rests() {
    return world_turning([](double t_s) {
        return Vector3{world_rate_x_rad_s(t_s), peak_rad_s(t_s) * std::sin(2.0 * pi * t_s / 2.3),
                       peak_rad_s(t_s) * std::sin(2.0 * pi * t_s / 1.7)};
    });
}

// Four sines an axis, none at a frequency of another axis.
double steady_rate_rad_s(std::size_t axis, double t_s) {
    constexpr std::array<double, 4> f_hz = {0.31, 1.37, 2.93, 4.61};
    constexpr std::array<double, 4> size_rad_s = {0.5, 0.3, 0.2, 0.12};
    const auto place = static_cast<double>(axis);
    double rate_rad_s = 0.0;
    for (std::size_t i = 0; i < f_hz.size(); ++i) {
        const double phase_rad = 0.3 * place + static_cast<double>(i);
        rate_rad_s += size_rad_s[i] * std::sin(2.0 * pi * f_hz[i] * (1.0 + 0.07 * place) * t_s + phase_rad);
    }
    return rate_rad_s;
}

std::shared_ptr<const World> world_without_rests(double times = 1.0) {
    return world_turning([times](double t_s) {
        return Vector3{times * steady_rate_rad_s(0, t_s), times * steady_rate_rad_s(1, t_s),
                       times * steady_rate_rad_s(2, t_s)};
    });
}

SensorModel moving_sensor() {
    SensorModel model = calibrated_sensor();
    model.ref_noise_rad_s = 0.02 * rad_per_deg;
    model.sd_abs = {{"M", 2e-4}, {"latency_s", 1e-4}, {"rate_rel", 5e-5}};
    return model;
}

const Finding* of(const Hypotheses& hypotheses, const std::string& effect) {
    for (const std::optional<Finding>& finding : hypotheses.findings) {
        if (finding && finding->effect == effect) { return &*finding; }
    }
    return nullptr;
}

double evidence_of(const Hypotheses& hypotheses, const std::string& effect) {
    const Finding* found = of(hypotheses, effect);
    return found == nullptr ? 0.0 : found->evidence_nats;
}

double response_nats(const char* effect, const std::shared_ptr<const Recording>& recording,
                     const SensorModel& model) {
    return evidence(found(make_mean_response_estimator, effect, recording, model));
}

Hypotheses examined(const SensorModel& sensor, const SensorModel& model, std::uint64_t seed) {
    const auto recording = recorded(sensor, 48000, seed, world_with_rests());
    return examine(prediction_of(recording, model), recording, 1, 1);
}

// What a filter leaves of a turn, it leaves of the gains that the model states too.
TEST(MotionEvidence, OfGainsBehindAFilterIsWhatTheModelDoesNotState) {
    const SensorModel model =
        with_effect(moving_sensor(), "lowpass", {{"fc_hz", 0.5}, {"order", 2.0}}, {"x", "y", "z"});
    SensorModel sensor = model;
    sensor.M[0][1] += 4e-4;  // two of the stated standard deviations
    const Hypotheses seen = examined(sensor, model, 36);
    const Finding* leak = of(seen, "misalignment");
    ASSERT_NE(leak, nullptr);
    EXPECT_LT(leak->evidence_nats, 5.0);
    const Finding* size = of(seen, "scale_factor");
    ASSERT_NE(size, nullptr);
    EXPECT_LT(size->evidence_nats, 5.0);
}

TEST(MotionEvidence, OfAScaleFactorIsWhatTheStatedGainsDoNotCover) {
    const SensorModel model = moving_sensor();
    const double eps = 0.008;
    const Hypotheses seen = examined(with_effect(model, "scale_factor", {{"eps", eps}}, {"x"}), model, 31);
    const Finding* found = of(seen, "scale_factor");
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->where.axes, std::vector<std::size_t>{0});
    // The motion knows the gain far better than the model states it: the gain in nats is the prior's.
    const double expected_nats = 0.5 * eps * eps / (2e-4 * 2e-4);
    EXPECT_NEAR(found->gain_nats, expected_nats, 0.05 * expected_nats);
    EXPECT_NEAR(found->entries.front().params.at("eps"), eps, 4.0 * found->sd.front().at("eps"));
    EXPECT_EQ(seen.best()->effect, "scale_factor")
        << seen.best()->evidence_nats << " against " << found->evidence_nats;
}

TEST(MotionEvidence, OfALatencyIsWhatTheStatedOneDoesNotCover) {
    const SensorModel model = moving_sensor();
    const double delay_s = 0.0018;
    const Hypotheses seen = examined(with_effect(model, "latency", {{"delay_s", delay_s}}, {}), model, 36);
    const Finding* found = of(seen, "latency");
    ASSERT_NE(found, nullptr);
    EXPECT_NEAR(found->entries.front().params.at("delay_s"), delay_s, 2e-4) << "as far as it is stated";
    // The motion knows the delay far better than the model states it: the gain is the prior's, once for all
    // axes.
    const double expected_nats = 0.5 * delay_s * delay_s / (1e-4 * 1e-4);
    EXPECT_NEAR(found->gain_nats, expected_nats, 0.1 * expected_nats);
    EXPECT_EQ(seen.best(), found) << seen.best()->effect;
}

// A filter so fast would be as late, and fold several times the noise.
TEST(MotionEvidence, OfALatencyInSlowMotionIsNoLowPass) {
    const auto slow = world_turning([](double t_s) {
        return Vector3{0.8 * std::sin(1.9 * t_s), 0.7 * std::sin(1.3 * t_s), 0.6 * std::sin(2.3 * t_s)};
    });
    const SensorModel model = moving_sensor();
    const auto recording =
        recorded(with_effect(model, "latency", {{"delay_s", 0.0009}}, {}), 48000, 39, slow);
    const Hypotheses seen = examine(prediction_of(recording, model), recording, 1, 1);
    EXPECT_LE(evidence_of(seen, "lowpass"), 0.0);
    ASSERT_NE(seen.best(), nullptr);
    EXPECT_EQ(seen.best()->effect, "latency");
    const SensorModel filtered = with_effect(model, "lowpass", {{"fc_hz", 10.0}, {"order", 1.0}}, {});
    EXPECT_GT(response_nats("lowpass", recorded(filtered, 48000, 39, slow), model), 20.0);
}

void expect_low_pass_alone(const std::shared_ptr<const World>& world) {
    const SensorModel model = moving_sensor();
    const SensorModel sensor = with_effect(model, "lowpass", {{"fc_hz", 15.77}, {"order", 1.0}}, {});
    const auto recording = recorded(sensor, 48000, 38, world);
    const std::optional<CauseSelection> found =
        select_causes(examine(prediction_of(recording, model), recording, 1, 1), recording, {});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->causes.size(), 1U);
    const Finding& cause = found->causes.front().finding;
    EXPECT_EQ(cause.effect, "lowpass");
    EXPECT_NEAR(cause.entries.front().params.at("fc_hz"), 15.77, 4.0 * cause.sd.front().at("fc_hz"));
}

// Of a hundred units that are what their models say, two are as late as that: on all axes.
TEST(MotionEvidence, OfALatencyWithinItsUncertaintyIsNone) {
    const SensorModel model = moving_sensor();
    SensorModel sensor = model;
    sensor.latency_s += 2.4e-4;
    const Hypotheses seen = examined(sensor, model, 37);
    const Finding* found = of(seen, "latency");
    ASSERT_NE(found, nullptr);
    EXPECT_LT(found->evidence_nats, 2.0);
}

// A tracker may be late by five times what a sensor plausibly is.
TEST(MotionEvidence, FindsALatencyFarBeyondTheTrials) {
    const SensorModel model = moving_sensor();
    const auto recording =
        recorded(with_effect(model, "latency", {{"delay_s", 0.05}}, {}), 24'000, 41, world_without_rests());
    const auto finding = found(make_mean_response_estimator, "latency", recording, model);
    ASSERT_TRUE(finding);
    EXPECT_NEAR(finding->entries.front().params.at("delay_s"), 0.05, 4.0 * finding->sd.front().at("delay_s"));
    EXPECT_LT(finding->sd.front().at("delay_s"), 1e-3);
}

// A sample of a beat is up to a whole sample old, as its repeats tell.
TEST(MotionEvidence, OfABeatThatTheModelHasIsNone) {
    const SensorModel model = with_effect(moving_sensor(), "stale", {{"eps", 0.0722}});
    const auto recording = recorded(model, 24'000, 43, world_without_rests());
    const auto prediction = prediction_of(recording, model);
    EXPECT_LT(response_nats("latency", recording, model), 3.0);
    EXPECT_LT(evidence(found(make_line_estimator, "tone", recording, model)), 3.0);
    const Observation seen(prediction, recording, 1);
    const Observation without(prediction->with(moving_sensor()), recording, 1);
    double left = 0.0;
    double left_without = 0.0;
    for (std::size_t slot = 0; slot < prediction->length(); ++slot) {
        if (!seen.present()[slot]) { continue; }
        left += square(static_cast<double>(seen.axis(0).residual_rad_s[slot]));
        left_without += square(static_cast<double>(without.axis(0).residual_rad_s[slot]));
    }
    EXPECT_LT(left, 0.01 * left_without);
}

// Of a beat that the recording has not, its samples are half a sample old in the mean.
TEST(MotionEvidence, OfABeatThatIsNotRecordedIsOfItsMeanAge) {
    const SensorModel model = moving_sensor();
    const auto recording = recorded(model, 24'000, 43, world_without_rests());
    const auto prediction = prediction_of(recording, model);
    SensorModel older = model;
    older.latency_s += 0.5 / recording->rate_hz;
    const auto in_mean = noise_free_response(*prediction, older);
    EXPECT_EQ(noise_free_response(*prediction, with_effect(model, "stale", {{"eps", 0.0722}})), in_mean);
    EXPECT_NE(noise_free_response(*prediction, model), in_mean);
    const SensorModel read_twice = with_effect(model, "stale", {{"eps", 0.0722}, {"run_length", 1.0}});
    EXPECT_EQ(noise_free_response(*prediction, read_twice), noise_free_response(*prediction, model));
}

// Its lag looks like latency, what it takes off the motion like noise; only with it nothing else is left.
TEST(MotionEvidence, OfALowPassIsThatAlone) { expect_low_pass_alone(world_with_rests()); }

// What is left of the reference's noise is filtered with the motion, and then missing where it is expected.
TEST(MotionEvidence, OfALowPassIsThatAloneWithoutARest) { expect_low_pass_alone(world_without_rests()); }

// However well the motion knows the cut-off.
TEST(MotionEvidence, OfALowPassIsFittedAsWellAsTheTruth) {
    const SensorModel model = moving_sensor();
    const SensorModel sensor = with_effect(model, "lowpass", {{"fc_hz", 5.5}, {"order", 1.0}}, {});
    const auto recording = recorded(sensor, 48000, 42, world_without_rests(4.0));
    const auto prediction = prediction_of(recording, model);
    const Hypotheses seen = examine(prediction, recording, 1, 1);
    const Finding* found = of(seen, "lowpass");
    ASSERT_NE(found, nullptr);
    const auto nats = [&](const SensorModel& with) {
        return log_likelihood_nats(Observation(prediction->with(with), recording, 1));
    };
    EXPECT_GT(nats(with_cause(model, *found)) - nats(sensor), -40.0) << "of 3e9";
}

// Fitted alone the low-pass takes most of the latency for its own, and leaves what looks like noise.
TEST(MotionEvidence, OfALowPassAndALatencyIsBoth) {
    const SensorModel model = moving_sensor();
    SensorModel sensor = with_effect(model, "lowpass", {{"fc_hz", 15.77}, {"order", 1.0}}, {});
    sensor = with_effect(sensor, "latency", {{"delay_s", 0.003}}, {});
    const auto recording = recorded(sensor, 24000, 43, world_without_rests());
    const std::optional<CauseSelection> found =
        select_causes(examine(prediction_of(recording, model), recording, 1, 2), recording, {});
    ASSERT_TRUE(found);
    std::map<std::string, double> values;
    for (const FoundCause& cause : found->causes) {
        for (const auto& [name, value] : cause.finding.entries.front().params) {
            values[cause.finding.effect + '.' + name] = value;
        }
    }
    EXPECT_EQ(found->causes.size(), 2U);
    EXPECT_NEAR(values["lowpass.fc_hz"], 15.77, 0.2);
    EXPECT_NEAR(values["latency.delay_s"], 0.003, 4e-4) << "stated to 1e-4 s";
}

// Samples taken at the wrong moment are off by the rate's change meanwhile: their variance goes with its
// square. The gain is the expected one against the best even level, which the model's N holds back.
TEST(MotionEvidence, OfUnevenMomentsIsTheVariancesCourse) {
    const SensorModel model = moving_sensor();
    for (const double sd_s : {8e-5, 2e-4}) {
        const Hypotheses seen =
            examined(with_effect(model, "clock_jitter", {{"sd_s", sd_s}, {"in_stamps", 0.0}}, {}), model, 40);
        const Finding* found = of(seen, "clock_jitter");
        ASSERT_NE(found, nullptr) << sd_s;
        EXPECT_EQ(seen.best(), found) << seen.best()->effect;
        EXPECT_NEAR(found->entries.front().params.at("sd_s"), sd_s, 4.0 * found->sd.front().at("sd_s"));
        const auto expected_nats = [&](double level) {
            double nats = 0.0;
            for (const std::size_t axis : {0U, 1U, 2U}) {
                const double white = seen.prediction->parts(axis).back().sum() * 100.0;
                const double share = seen.prediction->parts(axis).back().white * 100.0 / white;
                for (const float change : seen.prediction->response_change_rad_s2(axis)) {
                    const double off_rad_s = sd_s * static_cast<double>(change);
                    const double variance = 1.0 + off_rad_s * off_rad_s / white;
                    nats += 0.5 * (variance / level - 1.0 + std::log(level / variance));
                }
                nats += 0.5 * std::pow((level - 1.0) / (2.0 * 0.005 * share), 2.0);
            }
            return nats;
        };
        double least_nats = expected_nats(1.0);
        for (double level = 1.0; level < 1.5; level += 0.001) {
            least_nats = std::min(least_nats, expected_nats(level));
        }
        EXPECT_GT(least_nats, 100.0);
        EXPECT_NEAR(found->gain_nats, least_nats, 6.0 * std::sqrt(2.0 * least_nats)) << sd_s;
    }
}

TEST(MotionEvidence, OfAGainWithinItsUncertaintyIsNone) {
    SensorModel sensor = moving_sensor();
    sensor.M[0][0] += 2e-4;
    sensor.M[1][2] -= 2e-4;
    sensor.latency_s += 1e-4;
    const Hypotheses seen = examined(sensor, moving_sensor(), 32);
    sensor.M[0][0] += 2e-3;
    sensor.M[1][2] -= 2e-3;
    sensor.latency_s += 1e-3;
    const auto beyond = recorded(sensor, 48000, 32, world_with_rests());
    for (const char* effect : {"scale_factor", "misalignment", "latency"}) {
        EXPECT_LT(evidence_of(seen, effect), 3.0) << effect;
        EXPECT_GT(response_nats(effect, beyond, moving_sensor()), 10.0) << effect;
    }
}

TEST(MotionEvidence, OfAGainWithinItsUncertaintyIsNoneWhateverTheClock) {
    SensorModel model = moving_sensor();
    model.effects.push_back({"clock_rate", {}, {{"rel", 0.002}, {"in_stamps", 0.0}}, ""});
    SensorModel sensor = model;
    sensor.M[0][0] += 2e-4;
    sensor.M[1][2] -= 2e-4;
    const Hypotheses seen = examined(sensor, model, 35);
    for (const char* effect : {"scale_factor", "misalignment"}) {
        const Finding* found = of(seen, effect);
        ASSERT_NE(found, nullptr) << effect;
        EXPECT_LT(found->evidence_nats, 3.0) << effect;
    }
}

// What is kept of the reference's noise comes later than what is not, and its spectrum must stay what it is:
// by plain lines it would be 360 nats off. Windows that change their width leave a little.
TEST(MotionEvidence, OfLittleNoiseWhateverTheClock) {
    SensorModel model = moving_sensor();
    model.effects.push_back({"clock_rate", {}, {{"rel", 0.004}, {"in_stamps", 0.0}}, ""});
    const auto world = world_turning([](double t_s) {
        return Vector3{0.1 * std::sin(2.0 * pi * t_s / 19.0), 0.1 * std::sin(2.0 * pi * t_s / 23.0),
                       0.1 * std::sin(2.0 * pi * t_s / 29.0)};
    });
    const auto recording = recorded(model, 96000, 41, world);
    const Hypotheses seen = examine(prediction_of(recording, model), recording, 1, 1);
    for (const char* effect : {"gauss_markov", "flicker_missing", "arw_scale"}) {
        const Finding* found = of(seen, effect);
        ASSERT_NE(found, nullptr) << effect;
        EXPECT_LT(found->evidence_nats, 25.0) << effect;
    }
}

TEST(MotionEvidence, TakesTheReferencesNoiseForNoDeadZone) {
    const Hypotheses seen = examined(moving_sensor(), moving_sensor(), 33);
    EXPECT_LT(evidence_of(seen, "dead_zone"), 3.0);
    const SensorModel dead = with_effect(moving_sensor(), "dead_zone", {{"width_dps", 0.3}, {"jump", 0.0}});
    EXPECT_GT(response_nats("dead_zone", recorded(dead, 48000, 33, world_with_rests()), moving_sensor()),
              20.0);
    const Finding* best = seen.best();
    ASSERT_NE(best, nullptr);
    EXPECT_LT(best->evidence_nats, 6.0) << best->effect;
}

// One whose answer jumps to the full rate within the noise is not told from what is left of that: it is said
// to be another one, whose answer lacks the width at all rates.
TEST(MotionEvidence, OfADeadZoneIsWhatShowsBeyondTheReferencesNoise) {
    const auto world = world_turning([](double t_s) {
        const double rate_rad_s = 0.03 * rad_per_deg * std::sin(2.0 * pi * t_s / 31.0);
        return Vector3{rate_rad_s, rate_rad_s, rate_rad_s};
    });
    const SensorModel model = moving_sensor();
    for (const double width_dps : {0.016, 0.028}) {
        const SensorModel sensor =
            with_effect(model, "dead_zone", {{"width_dps", width_dps}, {"jump", 1.0}}, {"x", "y", "z"});
        const auto recording = recorded(sensor, 48000, 45, world);
        const auto finding = found(make_mean_response_estimator, "dead_zone", recording, model);
        ASSERT_TRUE(finding) << width_dps;
        EXPECT_EQ(finding->entries[0].params.at("jump"), width_dps > 0.02 ? 1.0 : 0.0) << width_dps;
    }
}

std::shared_ptr<const Recording> moved(const SensorModel& sensor, std::uint64_t seed) {
    return recorded(sensor, 48000, seed, world_with_rests());
}

// A noise sigma below the top of the motion, where the mean answer has next to nothing of it.
TEST(MotionEvidence, OfACeilingIsThePileOfSamplesBelowIt) {
    const SensorModel model = moving_sensor();
    const double limit_dps = 2.0 * deg_per_rad - 0.1;
    const SensorModel clipped = with_effect(model, "saturation", {{"limit_dps", limit_dps}}, {"x"});
    const auto recording = moved(clipped, 37);
    const auto finding = found(make_saturation_estimator, "saturation", recording, model);
    ASSERT_TRUE(finding);
    EXPECT_GT(finding->evidence_nats, 20.0);
    EXPECT_EQ(finding->where.axes, std::vector<std::size_t>{0});
    const double lsb_dps = model.lsb_rad_s * deg_per_rad;
    EXPECT_NEAR(finding->entries.front().params.at("limit_dps"), limit_dps, 0.5001 * lsb_dps);
    EXPECT_LT(
        evidence(found(make_saturation_estimator, "saturation", recording, with_cause(model, *finding))),
        0.0);
}

TEST(MotionEvidence, IsNotTakenFromClippedSamplesAndThreeOnEitherSide) {
    const SensorModel clipped = with_effect(moving_sensor(), "saturation", {{"limit_dps", 100.0}}, {"x"});
    const auto recording = moved(clipped, 39);
    std::vector<bool> judged(recording->rows(), true);
    find_effect("saturation")->signature->unjudged(*recording, clipped.effects.back(), judged);
    const Column& x = *recording->find("gx");
    const double highest_rad_s = std::ranges::max(x.values());
    std::size_t left_out = 0;
    for (std::size_t row = 3; row + 3 < recording->rows(); ++row) {
        bool near_clipped = false;
        for (std::size_t i = row - 3; i <= row + 3; ++i) {
            near_clipped = near_clipped || std::fabs(x.value(i)) == highest_rad_s;
        }
        ASSERT_EQ(judged[row], !near_clipped) << row;
        left_out += near_clipped ? 1 : 0;
    }
    EXPECT_GT(left_out, 500U);
}

// What is clipped over whole tops of the motion leaves holes there; gains must not be read from what fills
// them.
TEST(MotionEvidence, OfNothingElseIsLeftUnderAKnownCeiling) {
    SensorModel model = with_effect(moving_sensor(), "saturation", {{"limit_dps", 100.0}}, {"x", "y"});
    SensorModel sensor = model;
    sensor.M[0][0] += 2e-4;
    const auto recording = moved(sensor, 38);
    const Hypotheses seen = examine(prediction_of(recording, model), recording, 1, 1);
    const Finding* best = seen.best();
    ASSERT_NE(best, nullptr);
    EXPECT_LT(best->evidence_nats, 6.0) << best->effect;
}

TEST(MotionEvidence, OfACeilingIsNoneWhereTheMotionTurnsRound) {
    for (std::uint64_t seed = 41; seed <= 46; ++seed) {
        EXPECT_LT(evidence(found(make_saturation_estimator, "saturation", moved(moving_sensor(), seed),
                                 moving_sensor())),
                  3.0)
            << seed;
    }
}

TEST(DenoisedReference, OfSteadySwingsHasLittleNoiseBeyondThem) {
    const SensorModel model = moving_sensor();
    const auto recording = recorded(model, 24000, 39, world_without_rests());
    const auto denoised = without_reference_noise(RecordedWorld(recording), model.ref_noise_rad_s);
    const Column& after = *denoised->recording().find("ref_x");
    double sum = 0.0;
    constexpr std::size_t first = 1000;
    constexpr std::size_t end = 23000;
    for (std::size_t i = first; i < end; ++i) {
        const double error = after.value(i) - steady_rate_rad_s(0, static_cast<double>(i) / 100.0);
        sum += error * error;
    }
    // Up to 1.25 times the fastest swing all of the noise's even spectrum is kept, to 1.6 times half of it.
    const double kept = 0.5 * (1.25 + 1.6) * 4.61 / 50.0;
    EXPECT_LT(std::sqrt(sum / (end - first)), 1.2 * std::sqrt(kept) * model.ref_noise_rad_s);
}

// One value that is not known made the motion of its whole segment unknown.
TEST(DenoisedReference, IsKnownBesideASampleThatIsNot) {
    const SensorModel model = moving_sensor();
    const auto recording = recorded(model, 24000, 39, world_without_rests());
    Recording with_a_gap = *recording;
    const auto column = std::ranges::find(with_a_gap.columns, std::string("ref_x"), &Column::name);
    std::vector<double> values = column->values();
    values[7000] = std::nan("");
    column->data = std::move(values);
    column->scale = 1.0;
    const auto whole = without_reference_noise(RecordedWorld(recording), model.ref_noise_rad_s);
    const auto gapped = without_reference_noise(
        RecordedWorld(std::make_shared<const Recording>(std::move(with_a_gap))), model.ref_noise_rad_s);
    const Column& expected = *whole->recording().find("ref_x");
    const Column& seen = *gapped->recording().find("ref_x");
    // What a straight line over two samples leaves of swings that bend by 192 rad/s^3.
    constexpr double bend_rad_s = 0.5 * 192.0 * 0.01 * 0.01;
    for (std::size_t row = 0; row < expected.size(); ++row) {
        ASSERT_NEAR(seen.value(row), expected.value(row), bend_rad_s) << row;
    }
}

TEST(DenoisedReference, HasNoNoiseAtRestAndTheWholeMotionOtherwise) {
    const SensorModel model = moving_sensor();
    const auto recording = recorded(model, 24000, 34, world_with_rests());
    const auto denoised = without_reference_noise(RecordedWorld(recording), model.ref_noise_rad_s);
    const Column& before = *recording->find("ref_x");
    const Column& after = *denoised->recording().find("ref_x");
    const auto rms = [](const auto& error, std::size_t first, std::size_t end) {
        double sum = 0.0;
        for (std::size_t i = first; i < end; ++i) { sum += error(i) * error(i); }
        return std::sqrt(sum / static_cast<double>(end - first));
    };
    // At rest, from one second on: windows of eight seconds leave a twentieth.
    EXPECT_LT(rms([&](std::size_t i) { return after.value(i); }, 100, 5900), 0.08 * model.ref_noise_rad_s);
    int turning = 0;
    for (std::size_t i = 100; i < 5900; ++i) { turning += after.value(i) != 0.0; }
    EXPECT_LT(turning, 580) << "what is at rest does not turn";
    // On the move: no further from the truth than the noise is.
    const auto error = [&](std::size_t i) {
        return after.value(i) - world_rate_x_rad_s(static_cast<double>(i) / 100.0);
    };
    EXPECT_LT(rms(error, 6100, 11900), 1.5 * model.ref_noise_rad_s);
    EXPECT_NEAR(rms([&](std::size_t i) { return before.value(i); }, 100, 5900), model.ref_noise_rad_s,
                0.05 * model.ref_noise_rad_s);
}

}  // namespace
}  // namespace gyrolog
