#include "analysis/diagnose/estimators/catalogue.hpp"

#include <functional>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/diagnose/observed.hpp"

namespace gyrolog {
namespace {

using ::testing::ElementsAre;

std::set<std::string> effects_with(const std::function<bool(const EstimatorTraits&)>& trait) {
    std::set<std::string> effects;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        if (trait(traits_of(link.effect->name))) { effects.insert(std::string(link.effect->name)); }
    }
    return effects;
}

TEST(Catalogue, HasARowForTheEstimatorOfEveryEffect) {
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        if (link.effect->signature->method == EvidenceMethod::described) { continue; }
        EXPECT_NE(traits_of(link.effect->name).make, nullptr) << link.effect->name;
        EXPECT_EQ(traits_of(link.effect->name).method, link.effect->signature->method) << link.effect->name;
    }
}

TEST(Catalogue, HasNoneForAnEffectThatNothingLooksFor) {
    for (const char* effect : {"self_heating", "vibration_rectification", "temp_scale", "angle_noise"}) {
        ASSERT_EQ(find_effect(effect)->signature, nullptr) << effect;
        EXPECT_EQ(traits_of(effect).make, nullptr) << effect;
        EXPECT_FALSE(traits_of(effect).is_line) << effect;
    }
    // A person may ask for these.
    for (const char* effect : {"biquad", "level_table", "time_table"}) {
        ASSERT_EQ(find_effect(effect)->signature->method, EvidenceMethod::described) << effect;
        EXPECT_EQ(traits_of(effect).make, nullptr) << effect;
    }
}

TEST(Catalogue, KnowsWhatEachEffectIs) {
    EXPECT_THAT(effects_with([](const auto& t) { return t.is_in_stamps; }),
                ElementsAre("clock_jitter", "clock_rate", "dropped"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.is_beside_noise && !t.is_response; }),
                ElementsAre("clock_jitter", "clock_rate", "dropped", "rate_table", "saturation",
                            "temperature_table"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.is_response && !t.is_beside_noise; }),
                ElementsAre());
    EXPECT_THAT(effects_with([](const auto& t) { return t.is_line; }), ElementsAre("tone"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.recurs; }),
                ElementsAre("bias_step", "narrowband", "tone"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.is_of_codes; }), ElementsAre("quantization"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.is_not_normal; }),
                ElementsAre("disturbance", "heavy_tail", "rtn", "spikes"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.is_noise; }),
                ElementsAre("arw_scale", "density_table", "flicker_missing", "gauss_markov", "heavy_tail",
                            "lowpass", "narrowband", "noise_colour", "rrw_missing", "rtn"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.far_off == FarOff::single_samples; }),
                ElementsAre("spikes"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.far_off == FarOff::in_distribution; }),
                ElementsAre("heavy_tail"));
    EXPECT_THAT(effects_with([](const auto& t) { return !t.shows_in_means; }),
                ElementsAre("clock_jitter", "clock_rate", "density_table", "disturbance", "dropped",
                            "heavy_tail", "quantization", "saturation", "stale"));
    EXPECT_THAT(effects_with([](const auto& t) { return t.is_counted; }),
                ElementsAre("dropped", "quantization", "saturation", "stale"));
    EXPECT_THAT(effects_with([](const auto& t) { return !t.can_be_halved; }),
                ElementsAre("clock_jitter", "clock_rate", "disturbance", "dropped", "quantization", "rtn",
                            "saturation", "spikes", "stale", "tone"));
}

// With the effect in the model its samples are left out. A clock's rate leaves out the last ones only.
TEST(Catalogue, ComparesNoLikelihoodsOfOtherSamples) {
    std::size_t effects = 0;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        if (link.effect->signature->unjudged == nullptr || link.effect->name == "clock_rate") { continue; }
        EXPECT_TRUE(traits_of(link.effect->name).changes_likelihood) << link.effect->name;
        ++effects;
    }
    EXPECT_GE(effects, 4U);
}

// In motion the mean answer tells far more of a filter than the noise does.
TEST(Catalogue, LooksForAFilterInTheMotionWhereThereIsOne) {
    const SensorModel model = typical_mpu9250();
    const auto at_rest = prediction_of(recorded(model, 2048, 1), model);
    const auto moving = prediction_of(recorded(model, 2048, 1, world_turning([](double t_s) {
                                                   return Vector3{t_s, 0.0, 0.0};
                                               })),
                                      model);
    ASSERT_TRUE(moving->moves());
    EXPECT_TRUE(traits_of("lowpass", *at_rest).is_noise);
    EXPECT_TRUE(traits_of("lowpass", *moving).is_response);
    EXPECT_FALSE(traits_of("lowpass", *moving).is_noise);
    EXPECT_TRUE(traits_of("tone", *moving).is_line);
}

TEST(Catalogue, LeavesOutOfMeansWhatFolds) {
    EXPECT_TRUE(shows_in_means(*find_effect("gauss_markov")->signature));
    EXPECT_FALSE(shows_in_means(*find_effect("lowpass")->signature));
    EXPECT_FALSE(shows_in_means(*find_effect("narrowband")->signature));
    EXPECT_FALSE(shows_in_means(*find_effect("noise_colour")->signature));
    EXPECT_FALSE(shows_in_means(*find_effect("heavy_tail")->signature));
}

}  // namespace
}  // namespace gyrolog
