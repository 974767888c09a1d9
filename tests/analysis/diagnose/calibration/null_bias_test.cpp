#include "analysis/diagnose/calibration/null_bias.hpp"

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

// Simulations of the model show no trace of most effects, and little of the others.
TEST(NullBias, IsNextToNothingWhereTheLikelihoodsAreRight) {
    SensorModel model = calibrated_sensor();
    model = with_effect(model, "gauss_markov", {{"sigma_dps", 0.05}, {"tau_s", 0.5}}, {});
    const auto recording = recorded(model, 60'000, 21);
    const auto bias_nats =
        null_bias_nats(examine(prediction_of(recording, model), recording, 1, 2), 1, 2, [] { return true; });
    ASSERT_TRUE(bias_nats);
    for (const char* effect : {"flicker_missing", "rrw_missing", "bias_step", "heavy_tail", "tone", "rtn"}) {
        ASSERT_TRUE(bias_nats->contains(effect)) << effect;
        EXPECT_GE(bias_nats->at(effect), 0.0) << effect;
        // Sixteen draws of a chi-square over two and their fourfold standard deviation; 20 nats are beyond
        // any chance.
        EXPECT_LT(bias_nats->at(effect), 20.0) << effect;
    }
}

}  // namespace
}  // namespace gyrolog
