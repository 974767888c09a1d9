#include "analysis/simulate/plain_model.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "analysis/noise/noise_model.hpp"
#include "analysis/simulate/recording_simulator.hpp"
#include "tests/analysis/simulate/simulated.hpp"

namespace gyrolog {
namespace {

Recording made(const SensorModel& model, std::uint64_t samples,
               std::shared_ptr<const World> world = nullptr) {
    SimulationRequest request;
    request.samples = samples;
    request.seed = 7;
    request.world = std::move(world);
    return simulate_recording(model, request);
}

// 500 dps in 16 bits.
SensorModel sensor() {
    SensorModel model = white_model(0.005 * rad_per_deg);
    model.rate_hz = 200.0;
    model.lsb_rad_s = 500.0 / 32768.0 * rad_per_deg;
    model.saturation_rad_s = model.full_scale_rad_s;
    model.axes[1].noise.N_rad_per_sqrt_s *= 3.0;
    model.axes[2].bias_rad_s = 0.4 * rad_per_deg;
    return model;
}

TEST(PlainModel, IsTheWhiteNoiseAndTheBiasOfASensorThatHasNothingElse) {
    const SensorModel truth = sensor();
    const auto plain = plain_model(made(truth, 60'000));
    ASSERT_TRUE(plain);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double N = truth.axes[axis].noise.N_rad_per_sqrt_s;
        const double sd_rel = plain->model.axes[axis].sd_rel.at("N");
        // 300 s of 1 s each: an overlapping estimate has up to 1.5 times as many degrees of freedom.
        EXPECT_GT(sd_rel, 1.0 / std::sqrt(2.0 * 1.6 * 300.0));
        EXPECT_LT(sd_rel, 1.0 / std::sqrt(2.0 * 0.9 * 300.0));
        // The converter's share of a sample's variance, on the quietest axis: lsb^2 / 12 of N^2 rate.
        EXPECT_NEAR(plain->model.axes[axis].noise.N_rad_per_sqrt_s / N, 1.0, 4.0 * sd_rel + 0.01);
        EXPECT_NEAR(plain->model.axes[axis].bias_rad_s, truth.axes[axis].bias_rad_s,
                    4.0 * N / std::sqrt(300.0));
        EXPECT_EQ(plain->model.axes[axis].noise.B_rad_per_s, 0.0);
    }
    EXPECT_EQ(plain->model.rate_hz, 200.0);
    EXPECT_NEAR(plain->model.lsb_rad_s, truth.lsb_rad_s, 1e-9 * truth.lsb_rad_s);
    EXPECT_EQ(plain->still.from_s, 0.0);
    EXPECT_NEAR(plain->still.to_s, 300.0, 1.5);
    EXPECT_TRUE(plain->model.effects.empty());
}

TEST(PlainModel, IsOfThePartThatIsAtRest) {
    const auto plain = plain_model(
        made(sensor(), 24'000, world_turning([](double t_s) {
                 const double moving = t_s < 40.0 || t_s > 100.0 ? 1.0 : 0.0;
                 return Vector3{moving * std::sin(2.0 * t_s), 0.0, moving * 0.5 * std::sin(3.0 * t_s)};
             })));
    ASSERT_TRUE(plain);
    EXPECT_NEAR(plain->still.from_s, 40.0, 1.5);
    EXPECT_NEAR(plain->still.to_s, 100.0, 1.5);
    const double N = sensor().axes[0].noise.N_rad_per_sqrt_s;
    EXPECT_NEAR(plain->model.axes[0].noise.N_rad_per_sqrt_s / N, 1.0,
                4.0 * plain->model.axes[0].sd_rel.at("N") + 0.01);
}

TEST(PlainModel, IsNoneOfWhatNeverRestsOrIsNoRate) {
    const auto turning = world_turning([](double t_s) { return Vector3{std::sin(2.0 * t_s), 0.0, 0.0}; });
    EXPECT_FALSE(plain_model(made(sensor(), 12'000, turning)));
    Recording raw = made(sensor(), 12'000);
    for (Column& column : raw.columns) { column.unit = "lsb"; }
    EXPECT_FALSE(plain_model(raw));
}

TEST(PlainModel, OfMeansIsOfTheirSamples) {
    const auto plain = plain_model(means_of(made(sensor(), 60'000), 20));
    ASSERT_TRUE(plain);
    EXPECT_NEAR(plain->model.rate_hz, 200.0, 1e-9);
    const double N = sensor().axes[0].noise.N_rad_per_sqrt_s;
    EXPECT_NEAR(plain->model.axes[0].noise.N_rad_per_sqrt_s / N, 1.0,
                4.0 * plain->model.axes[0].sd_rel.at("N") + 0.01);
}

}  // namespace
}  // namespace gyrolog
