#include "analysis/diagnose/calibration/null_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

// Where there is no gap every probability is as likely as any other.
TEST(NullJudgement, OfASensorAsItsModelSaysIsRightOverItsWholeRange) {
    const auto recordings = static_cast<int>(seeds_asked(30));
    const SensorModel model = calibrated_sensor();
    NullJudgementOptions options;
    options.simulations.simulations = 40;
    std::vector<double> p;
    for (int i = 0; i < recordings; ++i) {
        const auto recording = recorded(model, 2048, 7000 + static_cast<std::uint64_t>(i));
        options.simulations.seed = static_cast<std::uint64_t>(i);
        p.push_back(judge_null(examine(prediction_of(recording, model), recording, 1, 0), options)->p_none);
    }
    for (const double level : {0.05, 0.1, 0.25, 0.5, 0.75, 0.9}) {
        const auto below =
            static_cast<double>(std::ranges::count_if(p, [&](double one) { return one <= level; }));
        // Three and a half standard deviations of the count, one step of 40 ranks, and the stamps' twentieth.
        const double sd = std::sqrt(recordings * level * (1.0 - level));
        const double tolerance = 3.5 * sd + recordings * (1.0 / 40.0 + 0.05 * level);
        EXPECT_NEAR(below, recordings * level, tolerance) << level;
    }
}

}  // namespace
}  // namespace gyrolog
