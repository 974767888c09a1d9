#include "host/formats/effect_words.hpp"

#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/simulate/chain.hpp"
#include "host/formats/wrapped_text.hpp"
#include "tests/host/formats/diagnosis_cases.hpp"

namespace gyrolog {
namespace {

using test::different_axes;
using test::late_temperature;
using testing::HasSubstr;
using testing::Not;

TEST(EffectWords, WriteQuantitiesInUnitsThatPeopleLike) {
    EXPECT_EQ(quantity_text("tau_s", 410.0, 60.0, nullptr), "6.8 ± 1.0 min");
    EXPECT_EQ(quantity_text("at_s", 9000.0, 0.0, nullptr), "2.5 h");
    EXPECT_EQ(quantity_text("delay_s", 0.0032, 0.0001, nullptr), "3.20 ± 0.10 ms");
    EXPECT_EQ(quantity_text("c1_dps_per_C", 0.021, 0.002, nullptr), "0.0210 ± 0.0020 deg/s per degC");
    EXPECT_EQ(quantity_text("c1_dps_per_C", -0.0005, 0.0, nullptr), "-1.8 deg/h per degC");
    EXPECT_EQ(quantity_text("c3_dps_per_C3", 0.004, 0.001, nullptr), "0.0040 ± 0.0010 deg/s per degC^3");
    EXPECT_EQ(quantity_text("ramp_dps_per_s", 1e-4, 0.0, nullptr), "0.36 deg/s per h");
    EXPECT_EQ(quantity_text("ramp_dps_per_s", 1e-8, 0.0, nullptr), "0.13 deg/h per h");
    EXPECT_EQ(quantity_text("sigma_dps", 0.0125, 0.0, nullptr), "0.0125 deg/s");
    EXPECT_EQ(quantity_text("B_dps", 0.0005, 0.0001, nullptr), "1.80 ± 0.36 deg/h");
    EXPECT_EQ(quantity_text("f_hz", 49.97, 0.01, nullptr), "49.970 ± 0.010 Hz");
    EXPECT_EQ(quantity_text("phase_rad", pi, 0.0, nullptr), "180 deg");
    EXPECT_EQ(quantity_text("per_C", 0.012, 0.001, nullptr), "1.20 ± 0.10 % per degC");
    EXPECT_EQ(quantity_text("per_hour", 3.2, 0.0, nullptr), "3.2 per hour");
    EXPECT_EQ(quantity_text("nu", 4.0, 0.5, nullptr), "4.00 ± 0.50");
    EXPECT_EQ(quantity_text("x_dps_per_g", 0.2, 0.0, nullptr), "0.2 deg/s per g");
}

TEST(EffectWords, WriteAParameterOfAModelInTheUnitOfItsName) {
    EXPECT_EQ(param_text("phase_rad", 2.484, 0.073), "phase_rad 2.484 ± 0.073 rad");
    EXPECT_EQ(param_text("tau_s", 410.0, 60.0), "tau_s 410 ± 60 s");
    EXPECT_EQ(param_text("B_dps", 0.0005, 0.0001), "B_dps (5.0 ± 1.0)e-04 deg/s");
    EXPECT_EQ(param_text("ramp_dps_per_s", 1e-4, 0.0), "ramp_dps_per_s 0.0001 deg/s per s");
    EXPECT_EQ(param_text("delay_s", 0.0032, 0.0), "delay_s 0.0032 s");
    EXPECT_EQ(param_text("per_C", 0.012, 0.001), "per_C 0.0120 ± 0.0010 per degC");
    EXPECT_EQ(param_text("eps", 0.0987, 0.0), "eps 0.0987");
    EXPECT_EQ(param_text("size_g", 0.0123, 0.0), "size_g 0.0123 g");
}

// The unit of each parameter that a model may have is in its name, and no other is written behind it.
TEST(EffectWords, KnowTheUnitInTheNameOfEveryParameter) {
    const std::map<std::string, std::string> units = {{"_dps", "deg/s"}, {"_rad", "rad"}, {"_hz", "Hz"},
                                                      {"_C", "degC"},    {"_s", "s"},     {"_g", "g"}};
    std::size_t with_unit = 0;
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr) { continue; }
        for (const EffectParam& param : link.effect->params) {
            const std::string name(param.name);
            const std::size_t last = name.rfind('_');
            if (name.find("_per_") != std::string::npos || name.find("sqrt") != std::string::npos ||
                last == std::string::npos || !units.contains(name.substr(last)) || name.ends_with("_dps_s") ||
                name == "per_C") {
                continue;
            }
            EXPECT_EQ(param_text(name, 1.0, 0.0), name + " 1 " + units.at(name.substr(last)));
            ++with_unit;
        }
    }
    EXPECT_GT(with_unit, 30U);
}

TEST(EffectWords, WriteSharesAndRelativeErrorsInPercentOrPpm) {
    const EffectParam* of_stale = find_effect("stale")->params.data();
    EXPECT_EQ(quantity_text("eps", 0.0987, 0.0, of_stale), "9.87 %");
    const EffectParam* of_clock = find_effect("clock_rate")->params.data();
    EXPECT_EQ(quantity_text("rel", 1.2e-4, 1e-5, of_clock), "120 ± 10 ppm");
    EXPECT_EQ(quantity_text("rel", -0.007, 0.0, of_clock), "-0.7 %");
}

TEST(EffectWords, PutValuesInTheirPlaces) {
    EXPECT_EQ(
        filled_words("The bias follows the temperature {tau_s} late, {c1_dps_per_C}.", late_temperature()),
        "The bias follows the temperature 6.8 ± 1.0 min late, 0.0210 ± 0.0020 deg/s per degC.");
    EXPECT_EQ(filled_words("{c1_dps_per_C}, {tau_s}", different_axes()),
              "0.0210 ± 0.0020 deg/s per degC (x), 0.0500 ± 0.0010 deg/s per degC (z), 6.8 ± 1.0 min");
    EXPECT_EQ(filled_words("a loop of {play_C}", late_temperature()), "a loop of 0 degC")
        << "the effect's own value of what was not fitted";
    EXPECT_EQ(filled_words("no values", late_temperature()), "no values");
    EXPECT_EQ(filled_words("It lags[, by {tau_s}][, in runs of {run_length}].", late_temperature()),
              "It lags, by 6.8 ± 1.0 min.")
        << "brackets hold what is said of what was fitted only";
}

Cause of_model(const std::string& name, const std::string& effect, std::map<std::string, double> params) {
    Cause cause;
    cause.sense = Sense::model_has;
    cause.finding.effect = name;
    cause.finding.entries = {{effect, {"x"}, std::move(params), ""}};
    cause.finding.sd = {{}};
    return cause;
}

TEST(EffectWords, SayWhatTheModelHasAndTheRecordingLacks) {
    EXPECT_EQ(cause_words(of_model("tone", "tone", {{"f_hz", 31.0}, {"amplitude_dps", 0.05}})),
              "The model has a line at 31 Hz that the recording lacks");
    EXPECT_EQ(cause_words(of_model("line_absent", "line_absent", {{"f_hz", 31.0}})),
              "The model has a line at 31 Hz that the recording lacks");
    EXPECT_EQ(cause_words(of_model("rrw_excess", "rrw_excess", {{"factor", 0.5}})),
              "The model has a rate random walk; the recording has 0.5 times as much");
    EXPECT_EQ(cause_words(of_model("flicker_excess", "flicker_excess", {})),
              "The model has flicker noise that the recording lacks");
    EXPECT_EQ(cause_words(of_model("arw_scale", "arw_scale", {{"factor", 0.8}})),
              "The model has white noise; the recording has 0.8 times as much");
    EXPECT_EQ(cause_words(of_model("effect_absent", "temp_linear", {{"c1_dps_per_C", 0.02}})),
              "The model has a temperature coefficient of 0.02 deg/s per degC that the recording lacks");
    EXPECT_EQ(cause_words(of_model("effect_absent", "self_heating", {})),
              "The model has `self_heating` that the recording lacks");
    EXPECT_EQ(
        cause_words(of_model("variance_change", "variance_change", {{"factor", 2.0}})),
        "The model has a change of the white noise to 2 times its standard deviation that the recording "
        "lacks");
    Cause lacking = of_model("rrw_missing", "rrw_missing", {{"K_dps_sqrt_hz", 0.002}});
    lacking.sense = Sense::recording_has;
    EXPECT_EQ(cause_words(lacking), effect_words(lacking.finding));
}

// A line may be mains, a motor, or one that somebody simulated.
TEST(EffectWords, SayWhatIsSeenAndNotWhatMadeIt) {
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        const std::string words(link.effect->signature->words);
        for (const char* origin :
             {"mains", "vibration", "supply", "outside", "turn-on", "read faster", "The bias"}) {
            EXPECT_THAT(words, Not(HasSubstr(origin))) << link.effect->name;
        }
    }
}

TEST(EffectWords, NameOnlyParametersThatTheEffectHas) {
    for (const ChainLink& link : signal_chain()) {
        if (link.effect == nullptr || link.effect->signature == nullptr) { continue; }
        for (const std::string_view words : {link.effect->signature->words, link.effect->signature->noun}) {
            EXPECT_FALSE(words.empty()) << link.effect->name;
            for (std::size_t open = words.find('{'); open != std::string_view::npos;
                 open = words.find('{', open + 1)) {
                const std::string_view name = words.substr(open + 1, words.find('}', open) - open - 1);
                EXPECT_TRUE(std::ranges::any_of(link.effect->params,
                                                [&](const EffectParam& param) { return param.name == name; }))
                    << link.effect->name << " {" << name << "}";
            }
        }
    }
}

TEST(WrappedText, BreaksAtSpacesAndCountsCharacters) {
    EXPECT_EQ(wrapped_text("- ", "one two three", 9), "- one two\n  three\n");
    EXPECT_EQ(wrapped_text("", "±± ±± ±±", 5), "±± ±±\n±±\n");
    EXPECT_EQ(wrapped_text("", "unbreakable", 3), "unbreakable\n");
    EXPECT_EQ(wrapped_text("- ", "", 9), "- \n");
}

}  // namespace
}  // namespace gyrolog
