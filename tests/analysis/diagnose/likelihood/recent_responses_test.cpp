#include "analysis/diagnose/likelihood/recent_responses.hpp"

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

RecentResponses::Response filled(std::size_t values, float with) {
    RecentResponses::Response response;
    response[0].assign(values, with);
    return response;
}

class RecentResponsesOfAWorld : public testing::Test {
protected:
    // What is recalled, and how often it was simulated.
    float recalled(const SensorModel& model, float simulated, std::size_t values = 10) {
        return recent_.recall(world_, model, [&] {
            ++simulated_;
            return filled(values, simulated);
        })[0][0];
    }

    const SensorModel model_ = calibrated_sensor();
    const std::shared_ptr<const Recording> recording_ = recorded(model_, 2048, 1);
    const std::shared_ptr<const RecordedWorld> world_ = std::make_shared<const RecordedWorld>(recording_);
    RecentResponses recent_;
    int simulated_ = 0;
};

TEST_F(RecentResponsesOfAWorld, AreSimulatedOnceForAModel) {
    EXPECT_EQ(recalled(model_, 1.0F), 1.0F);
    EXPECT_EQ(recalled(model_, 2.0F), 1.0F);
    EXPECT_EQ(simulated_, 1);
}

TEST_F(RecentResponsesOfAWorld, AreThoseOfTheModelAndOfTheWorld) {
    static_cast<void>(recalled(model_, 1.0F));
    EXPECT_EQ(recalled(with_effect(model_, "temp_linear", {{"c1_dps_per_C", 0.01}}, {"x"}), 2.0F), 2.0F);
    EXPECT_EQ(recalled(with_effect(model_, "temp_linear", {{"c1_dps_per_C", 0.02}}, {"x"}), 3.0F), 3.0F);
    SensorModel later = model_;
    later.latency_s = 1e-3;
    EXPECT_EQ(recalled(later, 4.0F), 4.0F);
    const auto other = std::make_shared<const RecordedWorld>(recording_);
    EXPECT_EQ(recent_.recall(other, model_, [] { return filled(10, 5.0F); })[0][0], 5.0F);
    EXPECT_EQ(recalled(model_, 6.0F), 1.0F);
}

TEST_F(RecentResponsesOfAWorld, AreForgottenTheOldestFirst) {
    const auto biased = [&](double bias_rad_s) {
        SensorModel model = model_;
        model.axes[0].bias_rad_s = bias_rad_s;
        return model;
    };
    const std::size_t third = (std::size_t{1} << 24) / 3;
    for (int i = 0; i < 3; ++i) { static_cast<void>(recalled(biased(i), 1.0F, third)); }
    static_cast<void>(recalled(biased(0), 2.0F, third));  // the latest by now
    EXPECT_EQ(simulated_, 3);
    static_cast<void>(recalled(biased(3), 1.0F, third));
    EXPECT_EQ(recalled(biased(0), 3.0F, third), 1.0F);
    EXPECT_EQ(recalled(biased(1), 3.0F, third), 3.0F);
    // What is larger than all that is kept is not kept.
    static_cast<void>(recalled(biased(4), 1.0F, 4 * third));
    EXPECT_EQ(recalled(biased(4), 4.0F, 4 * third), 4.0F);
}

}  // namespace
}  // namespace gyrolog
