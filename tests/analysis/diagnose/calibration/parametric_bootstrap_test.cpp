#include "analysis/diagnose/calibration/parametric_bootstrap.hpp"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/lag.hpp"
#include "analysis/diagnose/estimators/mean_response.hpp"
#include "analysis/diagnose/estimators/noise_spectrum.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

constexpr std::uint64_t ten_minutes = 60'000;  // samples

// With the sensor's own effects for the corrected model.
std::vector<Finding> spread(const std::shared_ptr<const Recording>& recording, const SensorModel& model,
                            const Finding& found, BootstrapOptions options = {}) {
    return *with_bootstrap_sd(prediction_of(recording, model), with_cause(model, found), {found}, options);
}

// A slow, strong noise: what its size gains its time constant loses, and ten minutes hold some seventy of
// them. Of 2 x 16 values 68.3 % lie within a standard deviation, 21.9 +- 2.6, or 3.7 where the two go
// together: two of these are allowed.
TEST(ParametricBootstrap, HoldsWhereParametersGiveWayToEachOther) {
    const SensorModel model = calibrated_sensor();
    int held = 0;
    int held_by_curvature = 0;
    for (std::uint64_t seed = 60; seed < 76; ++seed) {
        const std::map<std::string, double> put_in = {{"sigma_dps", 0.05}, {"tau_s", 4.0}};
        const auto recording = recorded(with_effect(model, "gauss_markov", put_in, {"x"}), ten_minutes, seed);
        const auto finding = found(make_noise_spectrum_estimator, "gauss_markov", recording, model);
        ASSERT_TRUE(finding);
        ASSERT_EQ(finding->entries.size(), 1U);
        const Finding known = spread(recording, model, *finding).front();
        for (const auto& [name, value] : put_in) {
            const double off = std::fabs(finding->entries[0].params.at(name) - value);
            held += off < known.sd[0].at(name) ? 1 : 0;
            held_by_curvature += off < finding->sd[0].at(name) ? 1 : 0;
            EXPECT_LT(off, 5.0 * known.sd[0].at(name)) << seed << ' ' << name;
        }
    }
    std::cout << held << " of 32 held, by the curvature alone " << held_by_curvature << '\n';
    EXPECT_GE(held, 15);
    EXPECT_LE(held, 29);
}

// The likelihood knows the edge of a dead zone to 1 mdeg/s, by a rate that it takes for true. The reference
// is noisy by 20.
TEST(ParametricBootstrap, HasTheReferencesNoise) {
    SensorModel model = calibrated_sensor();
    model.ref_noise_rad_s = 0.02 * rad_per_deg;
    model.sd_abs = {{"M", 2e-4}, {"latency_s", 1e-4}, {"rate_rel", 5e-5}};
    const auto world = world_turning([](double t_s) {
        return Vector3{0.01 * std::sin(2.0 * pi * t_s / 3.7), 0.01 * std::sin(2.0 * pi * t_s / 2.3),
                       0.01 * std::sin(2.0 * pi * t_s / 1.7)};
    });
    const auto recording = recorded(with_effect(model, "dead_zone", {{"width_dps", 0.15}, {"jump", 1.0}}, {}),
                                    24'000, 61, world);
    const auto finding = found(make_mean_response_estimator, "dead_zone", recording, model);
    ASSERT_TRUE(finding);
    const double sd_dps = spread(recording, model, *finding).front().sd[0].at("width_dps");
    std::cout << finding->entries[0].params.at("width_dps") << " curvature " << finding->sd[0].at("width_dps")
              << " spread " << sd_dps << "\n";
    EXPECT_LT(finding->sd[0].at("width_dps"), 0.002);
    EXPECT_GT(sd_dps, 0.002);
    EXPECT_LT(sd_dps, 0.03);
    EXPECT_NEAR(finding->entries[0].params.at("width_dps"), 0.15, 4.0 * sd_dps);
}

TEST(ParametricBootstrap, IsTheSameForAnyNumberOfThreadsAndEndsWhenTold) {
    const SensorModel model = calibrated_sensor();
    const auto recording = recorded(
        with_effect(model, "gauss_markov", {{"sigma_dps", 0.05}, {"tau_s", 4.0}}, {"x"}), ten_minutes, 60);
    const auto finding = found(make_noise_spectrum_estimator, "gauss_markov", recording, model);
    ASSERT_TRUE(finding);
    EXPECT_EQ(spread(recording, model, *finding, {.threads = 1}).front().sd,
              spread(recording, model, *finding, {.threads = 3}).front().sd);
    BootstrapOptions ended;
    ended.on_progress = [](double share) { return share < 0.3; };
    EXPECT_FALSE(
        with_bootstrap_sd(prediction_of(recording, model), with_cause(model, *finding), {*finding}, ended));
}

}  // namespace
}  // namespace gyrolog
