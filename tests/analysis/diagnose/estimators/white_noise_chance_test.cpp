#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/diagnose/estimators/outliers.hpp"
#include "analysis/diagnose/estimators/shared_noise.hpp"
#include "analysis/diagnose/estimators/tails.hpp"
#include "analysis/diagnose/estimators/variance_change_point.hpp"
#include "analysis/diagnose/estimators/variance_with_temperature.hpp"
#include "tests/analysis/diagnose/estimators/white_noise_case.hpp"

namespace gyrolog {
namespace {

struct Method {
    const char* effect;
    EstimatorMaker make;
};

constexpr Method methods[] = {
    {"heavy_tail", make_tail_estimator},
    {"spikes", make_outlier_estimator},
    {"variance_change", make_variance_change_point_estimator},
    {"temp_noise", make_variance_with_temperature_estimator},
    {"common_mode", make_shared_noise_estimator},
};

TEST(WhiteNoiseChance, HasNoMoreEvidenceThanItShould) {
    constexpr std::uint64_t records = 200;
    constexpr std::uint64_t samples = 4096;
    auto world = std::make_shared<FormulaWorld>();
    world->temperature_C = [](double t_s) { return 30.0 + 5.0 * triangle(t_s / 40.0); };
    std::array<std::array<int, 3>, std::size(methods)> above{};
    std::array<int, std::size(methods)> answered{};
    constexpr std::array<double, 3> nats = {0.0, 3.0, 5.0};
    for (std::uint64_t seed = 1; seed <= records; ++seed) {
        const auto seen = seen_effects(known_sensor(), {}, samples, seed, world);
        for (std::size_t m = 0; m < std::size(methods); ++m) {
            const auto found = seen.find(methods[m].effect, methods[m].make);
            if (!found) { continue; }
            ++answered[m];
            EXPECT_TRUE(std::isfinite(found->evidence_nats));
            for (std::size_t i = 0; i < nats.size(); ++i) { above[m][i] += found->evidence_nats > nats[i]; }
        }
    }
    // A Bayes factor of e^x comes by chance with a probability of e^-x at most: 10 and 1.3 of 200, three
    // standard deviations more at the most; above 0 a tenth.
    for (std::size_t m = 0; m < std::size(methods); ++m) {
        EXPECT_GT(answered[m], 0) << methods[m].effect;
        EXPECT_LE(above[m][0], 32) << methods[m].effect;
        EXPECT_LE(above[m][1], 10 + 9) << methods[m].effect;
        EXPECT_LE(above[m][2], 5) << methods[m].effect;
    }
}

TEST(WhiteNoiseChance, IsAsRareForShortRecordsAndSingleAxes) {
    for (const std::size_t axes : {std::size_t{1}, std::size_t{2}}) {
        int answered = 0;
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            const auto whole = seen_effects(known_sensor(), {}, 2048, seed);
            Recording recording = *whole.recording;
            std::erase_if(recording.columns, [&](const Column& column) {
                return column.name == "gx" || (axes == 1 && column.name == "gy") || column.name == "temp";
            });
            const auto seen =
                seen_with(known_sensor(), std::make_shared<const Recording>(std::move(recording)));
            for (const Method& method : methods) {
                const auto found = seen.find(method.effect, method.make);
                if (!found) { continue; }
                ++answered;
                EXPECT_TRUE(std::isfinite(found->gain_nats)) << method.effect;
                EXPECT_LT(found->evidence_nats, 6.0) << method.effect;
            }
            EXPECT_NE(seen.untestable("temp_noise", make_variance_with_temperature_estimator), "");
            EXPECT_EQ(seen.untestable("common_mode", make_shared_noise_estimator),
                      axes == 1 ? "the recording has one axis only" : "");
        }
        EXPECT_GT(answered, 0) << axes;
    }
}

}  // namespace
}  // namespace gyrolog
