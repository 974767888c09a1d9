#include "analysis/simulate/reference_noise.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

using testing::Each;

constexpr double gyro_noise_rad_s = 0.07 * rad_per_deg;  // of a sample

Recording turned_after(double at_s, double ref_noise_rad_s) {
    SensorModel model = white_model(gyro_noise_rad_s / std::sqrt(200.0));
    model.rate_hz = 200.0;
    model.ref_noise_rad_s = ref_noise_rad_s;
    SimulationRequest request;
    request.samples = 24'000;
    request.seed = 7;
    request.world = world_turning([at_s](double t_s) {
        return t_s > at_s ? Vector3{std::sin(2.0 * t_s), std::cos(3.0 * t_s), 0.0} : Vector3{};
    });
    return simulate_recording(model, request);
}

TEST(ReferenceNoise, IsThatOfTheSamplesWhereTheGyroRests) {
    const double sd_rad_s = 0.3 * gyro_noise_rad_s;
    const ReferenceNoise noise = reference_noise_at_rest(turned_after(60.0, sd_rad_s));
    // A variance from 12 000 third differences is known to sqrt(4.6 / 12 000).
    for (const double one_rad_s : noise.sd_rad_s) { EXPECT_NEAR(one_rad_s / sd_rad_s, 1.0, 0.03); }
    EXPECT_NEAR(noise.of_all_rad_s() / sd_rad_s, 1.0, 0.02);
}

// A twelfth of the variance is known better, from half of the recording, than all of it tells the sum.
TEST(ReferenceNoise, IsKnownWellWhereItIsSmallAndTheRestLong) {
    EXPECT_TRUE(reference_noise_at_rest(turned_after(60.0, 0.3 * gyro_noise_rad_s)).is_known_well);
    EXPECT_FALSE(reference_noise_at_rest(turned_after(60.0, 2.0 * gyro_noise_rad_s)).is_known_well);
    EXPECT_FALSE(reference_noise_at_rest(turned_after(6.0, 0.7 * gyro_noise_rad_s)).is_known_well);
}

TEST(ReferenceNoise, IsNoneOfAnExactReferenceAndNoneWithoutARest) {
    EXPECT_THAT(reference_noise_at_rest(turned_after(60.0, 0.0)).sd_rad_s, Each(0.0));
    EXPECT_THAT(reference_noise_at_rest(turned_after(60.0, 1e-3 * gyro_noise_rad_s)).sd_rad_s, Each(0.0));
    EXPECT_THAT(reference_noise_at_rest(turned_after(0.0, gyro_noise_rad_s)).sd_rad_s, Each(0.0));
    EXPECT_EQ(ReferenceNoise{}.of_all_rad_s(), 0.0);
}

TEST(ReferenceNoise, OfAllAxesIsThatOfThoseThatHaveSome) {
    EXPECT_NEAR((ReferenceNoise{{3.0, 0.0, 4.0}, true}.of_all_rad_s()), std::sqrt(12.5), 1e-12);
}

}  // namespace
}  // namespace gyrolog
