#include "analysis/compare/model_draw.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

struct MeanAndSd {
    double mean, sd;
};

constexpr std::uint64_t draws = 4000;

MeanAndSd over_seeds(const SensorModel& model, const std::function<double(const SensorModel&)>& value) {
    double sum = 0.0;
    double square = 0.0;
    for (std::uint64_t seed = 0; seed < draws; ++seed) {
        const double x = value(draw_within_uncertainty(model, seed));
        sum += x;
        square += x * x;
    }
    const double mean = sum / draws;
    return {mean, std::sqrt(square / draws - mean * mean)};
}

void expect_scatter(const MeanAndSd& of, double mean, double sd) {
    EXPECT_NEAR(of.mean, mean, 4.0 * sd / std::sqrt(draws));
    EXPECT_NEAR(of.sd, sd, 4.0 * sd / std::sqrt(2.0 * draws));
}

TEST(ModelDraw, ScattersAsTheModelStatesItsUncertainties) {
    SensorModel model = typical_mpu9250();
    model.sd_rel = {{"N", 0.005}, {"B", 0.08}, {"K", 0.2}, {"timestamp_jitter", 0.05}};
    model.sd_abs = {{"M", 2e-4}, {"latency_s", 1e-4}, {"rate_rel", 5e-5}};
    model.axes[1].sd_rel = {{"N", 0.03}};
    const double N = model.axes[0].noise.N_rad_per_sqrt_s;
    expect_scatter(over_seeds(model, [](const auto& m) { return m.axes[0].noise.N_rad_per_sqrt_s; }), N,
                   0.005 * N);
    expect_scatter(over_seeds(model, [](const auto& m) { return m.axes[1].noise.N_rad_per_sqrt_s; }), N,
                   0.03 * N);  // its own
    const double K = model.axes[2].noise.K_rad_per_s_sqrt_s;
    expect_scatter(over_seeds(model, [](const auto& m) { return m.axes[2].noise.K_rad_per_s_sqrt_s; }), K,
                   0.2 * K);
    expect_scatter(over_seeds(model, [](const auto& m) { return m.M[0][0]; }), 1.0, 2e-4);
    expect_scatter(over_seeds(model, [](const auto& m) { return m.M[2][1]; }), 0.0, 2e-4);
    expect_scatter(over_seeds(model, [](const auto& m) { return m.latency_s; }), 0.0, 1e-4);
}

TEST(ModelDraw, DrawsEveryParameterByItself) {
    SensorModel model = typical_mpu9250();
    model.sd_rel = {{"N", 0.1}, {"B", 0.1}};
    const auto off = [&](const SensorModel& m, std::size_t axis) {
        return m.axes[axis].noise.N_rad_per_sqrt_s / model.axes[axis].noise.N_rad_per_sqrt_s - 1.0;
    };
    const double across_axes =
        over_seeds(model, [&](const auto& m) { return off(m, 0) * off(m, 1) / 0.01; }).mean;
    const double across_terms =
        over_seeds(model, [&](const auto& m) {
            return off(m, 0) * (m.axes[0].noise.B_rad_per_s / model.axes[0].noise.B_rad_per_s - 1.0) / 0.01;
        }).mean;
    EXPECT_NEAR(across_axes, 0.0, 4.0 / std::sqrt(draws));
    EXPECT_NEAR(across_terms, 0.0, 4.0 / std::sqrt(draws));
}

TEST(ModelDraw, LeavesWhatIsCertainAndTheBiasAndGivesNoNegativeNoise) {
    SensorModel model = typical_mpu9250();
    model.sd_rel = {{"B", 3.0}};
    model.sd_abs = {};
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const SensorModel drawn = draw_within_uncertainty(model, seed);
        EXPECT_EQ(drawn.axes[0].noise.N_rad_per_sqrt_s, model.axes[0].noise.N_rad_per_sqrt_s);
        EXPECT_EQ(drawn.axes[2].bias_rad_s, model.axes[2].bias_rad_s);
        EXPECT_EQ(drawn.M, model.M);
        EXPECT_GE(drawn.axes[0].noise.B_rad_per_s, 0.0);
    }
}

}  // namespace
}  // namespace gyrolog
