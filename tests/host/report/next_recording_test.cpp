#include "host/report/next_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/noise/walk_knowledge.hpp"

namespace gyrolog {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double N = 1e-4;
constexpr double K = 1e-6;

FittedCoefficient known(double value, double relative_sd) {
    FittedCoefficient fitted;
    fitted.state = FittedCoefficient::State::identified;
    fitted.value = value;
    fitted.sd = relative_sd * value;
    return fitted;
}

FittedCoefficient bounded(double upper) {
    FittedCoefficient fitted;
    fitted.upper = upper;
    return fitted;
}

FittedCoefficient& term(AxisReport& axis, NoiseTerm which) {
    return axis.fit.terms.at(static_cast<std::size_t>(which));
}

// An hour at 100 Hz of which everything is known.
AnalysisReport complete() {
    AnalysisReport analysis;
    analysis.rate_hz = 100.0;
    analysis.duration_s = 3600.0;
    analysis.stamps = StampKind::sampling;
    for (const char* name : {"x", "y"}) {
        AxisReport axis;
        axis.axis = name;
        for (const NoiseTerm which : all_noise_terms) { term(axis, which) = known(1e-6, 0.01); }
        axis.fit.best.coefficients = {0.0, N, 0.0, K, 0.0};
        analysis.axes.push_back(std::move(axis));
    }
    return analysis;
}

TEST(NextRecordings, AreNoneWhereNothingIsOpen) { EXPECT_THAT(next_recordings(complete(), true), IsEmpty()); }

TEST(NextRecordings, HaveTheLengthThatIdentifiesHalfOfTheLimit) {
    AnalysisReport analysis = complete();
    constexpr double upper = 2e-7;
    term(analysis.axes[1], NoiseTerm::K) = bounded(upper);
    const double needed_s =
        length_to_know_walk_s({0.0, N, 0.0, 0.5 * upper, 0.0}, analysis.rate_hz, 0.25).value();
    ASSERT_GT(needed_s, 3600.0) << "the case is none";
    const auto sentences = next_recordings(analysis, true);
    ASSERT_EQ(sentences.size(), 1U);
    EXPECT_THAT(sentences[0], AllOf(HasSubstr("K of y is not identified in 60 min"),
                                    HasSubstr("half of its upper limit, a recording of ")));
}

TEST(NextRecordings, AreNotAskedForWhereAYearWouldNotDo) {
    AnalysisReport analysis = complete();
    term(analysis.axes[0], NoiseTerm::B) = bounded(1e-12);
    EXPECT_THAT(next_recordings(analysis, true),
                Contains(AllOf(HasSubstr("B of x"), HasSubstr("that limit is the answer"))));
}

TEST(NextRecordings, AreLongerWhereATermIsVague) {
    AnalysisReport analysis = complete();
    term(analysis.axes[0], NoiseTerm::K) = known(K, 0.4);
    const double needed_s = length_to_know_walk_s({0.0, N, 0.0, K, 0.0}, 100.0, 0.2).value();
    analysis.duration_s = 0.5 * needed_s;
    EXPECT_THAT(next_recordings(analysis, true),
                Contains(HasSubstr("K of x is known to ±40 %; ±20 % take a recording of ")));
    // Where the record has the length, a longer one is not what it lacks.
    analysis.duration_s = 2.0 * needed_s;
    EXPECT_THAT(next_recordings(analysis, true), IsEmpty());
}

TEST(NextRecordings, AreWholeStampedAndHaveATemperature) {
    AnalysisReport analysis = complete();
    analysis.samples_missing = 12;
    analysis.stamps = StampKind::arrival;
    const auto sentences = next_recordings(analysis, false);
    EXPECT_THAT(sentences, Contains(HasSubstr("12 samples missing")));
    EXPECT_THAT(sentences, Contains(HasSubstr("time stamps of the sampling instants")));
    EXPECT_THAT(sentences, Contains(HasSubstr("temp_C")));
    EXPECT_THAT(next_recordings(analysis, true), Not(Contains(HasSubstr("temp_C"))));
}

TEST(NextRecordings, NameTheSensorWhereThereAreTwo) {
    AnalysisReport analysis = complete();
    analysis.accelerometer.emplace().axes = complete().axes;
    EXPECT_THAT(next_recordings(analysis, true), IsEmpty());
    term(analysis.accelerometer->axes[1], NoiseTerm::K) = bounded(2e-7);
    EXPECT_THAT(next_recordings(analysis, true),
                testing::ElementsAre(HasSubstr("Accelerometer: K of y is not identified")));
}

}  // namespace
}  // namespace gyrolog
