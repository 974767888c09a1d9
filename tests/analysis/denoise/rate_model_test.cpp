#include "analysis/denoise/rate_model.hpp"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "analysis/denoise/bandwidth_curve.hpp"
#include "tests/analysis/denoise/array_samples.hpp"

namespace gyrolog {
namespace {

TEST(RateModel, HalfOfThePowerPassesAtTheBandwidth) {
    const ArrayNoise noise = equal_units(3, 1.0, 1e-9);
    for (const RateModel model : {RateModel::walk, RateModel::trend}) {
        for (const double bandwidth_hz : {0.5, 5.0, 40.0}) {
            DenoiseDesign design;
            design.method = DenoiseMethod::kalman;
            design.rate = {model, bandwidth_hz};
            EXPECT_NEAR(filter_response(noise, design).half_power_hz, bandwidth_hz, 2e-3 * bandwidth_hz)
                << name_of(model) << ' ' << bandwidth_hz;
        }
    }
}

TEST(RateModel, AWalkLagsByItsTimeConstantAndATrendDoesNot) {
    const ArrayNoise noise = equal_units(3, 1.0, 1e-9);
    DenoiseDesign design;
    design.method = DenoiseMethod::kalman;
    design.rate = {RateModel::walk, 5.0};
    const double k = 1.0 - std::cos(2.0 * pi * 5.0 / 200.0);
    const double gain = -k + std::sqrt(k * k + 2.0 * k);
    const FilterResponse walk = filter_response(noise, design);
    EXPECT_NEAR(walk.lag_s, (1.0 - gain) / gain / 200.0, 1e-5);
    EXPECT_NEAR(walk.noise_ratio, gain / (2.0 - gain) / 3.0, 1e-6);
    design.rate.model = RateModel::trend;
    EXPECT_NEAR(filter_response(noise, design).lag_s, 0.0, 1e-5);
}

TEST(RateModel, AWiderBandPassesMoreNoiseWithLessLag) {
    DenoiseDesign design;
    design.rate = {RateModel::walk, 5.0};
    const std::vector<BandwidthPoint> curve =
        bandwidth_curve(equal_units(3, 1.0, 1e-9), design, RateModel::walk);
    ASSERT_GT(curve.size(), 10U);
    for (std::size_t i = 1; i < curve.size(); ++i) {
        EXPECT_GT(curve[i].kalman.noise_ratio, curve[i - 1].kalman.noise_ratio);
        EXPECT_LT(curve[i].kalman.lag_s, curve[i - 1].kalman.lag_s);
        EXPECT_LT(curve[i].joint.noise_ratio, curve[i].kalman.noise_ratio);
        EXPECT_GT(curve[i].joint.lag_s, curve[i].kalman.lag_s);
    }
}

}  // namespace
}  // namespace gyrolog
