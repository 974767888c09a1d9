#include "host/app/diagnosis_input.hpp"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/multiscale/long_diagnosis.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t rows_of_long = resolution::diagnosable_samples_max + 3000;
constexpr std::size_t rows_of_one_pass = resolution::beginning_max + 3000;

class DiagnosisInputTest : public testing::Test {
protected:
    RecordingInput written(const std::string& name, const std::string& columns, const std::string& line,
                           std::size_t rows) {
        RecordingInput input{folder_.path(name), 1000.0, std::nullopt};
        std::ofstream file(input.path);
        file << columns << '\n';
        for (std::size_t i = 0; i < rows; ++i) { file << (i % 2) << line << '\n'; }
        return input;
    }

    DiagnosisInput read(const RecordingInput& input) {
        const Result<DiagnosisInput> result = read_for_diagnosis(input);
        EXPECT_TRUE(result.ok()) << result.error().message;
        return result.ok() ? *result : DiagnosisInput{};
    }

    TemporaryFolder folder_;
};

TEST_F(DiagnosisInputTest, IsTheWholeOfWhatOneLookTakes) {
    for (const std::size_t rows : {std::size_t{5000}, rows_of_one_pass}) {
        const DiagnosisInput input = read(written("short.csv", "gx_dps", "", rows));
        EXPECT_EQ(input.samples->rows(), rows);
        EXPECT_EQ(input.means, nullptr);
        EXPECT_THAT(input.samples->warnings, IsEmpty());
    }
}

// A mean of more samples than there are is no empty recording.
TEST_F(DiagnosisInputTest, SaysThatAMeanIsLongerThanTheRecording) {
    RecordingInput input = written("short.csv", "gx_dps", "", 5000);
    input.samples_per_row = 100'000;
    const auto none = read_for_diagnosis(input);
    ASSERT_FALSE(none.ok());
    EXPECT_THAT(none.error().message, HasSubstr("`--average 100000` is longer than '"));
    EXPECT_THAT(none.error().message, HasSubstr("which has 5,000 samples; `--average 2` is the most"));
    input.samples_per_row = 100;
    const auto few = read_for_diagnosis(input);
    ASSERT_FALSE(few.ok());
    EXPECT_THAT(few.error().message, HasSubstr("it has 50 samples; a diagnosis needs at least 2048; "
                                               "`--average 2` is the most"));
}

TEST_F(DiagnosisInputTest, IsTheBeginningAndMeansOfAllOfALongRecordingAtRest) {
    const RecordingInput long_one = written("long.csv", "gx_dps", "", rows_of_long);
    const DiagnosisInput input = read(long_one);
    EXPECT_EQ(input.samples->rows(), resolution::beginning_max);
    ASSERT_NE(input.means, nullptr);
    EXPECT_EQ(input.means->samples_per_row, 100U);
    EXPECT_EQ(input.means->rows(), rows_of_long / 100);
    EXPECT_NEAR(input.means->rate_hz, 10.0, 1e-9);
    EXPECT_THAT(input.samples->warnings, IsEmpty());

    // A second recording is read like the first; as far as it is long enough.
    const Result<DiagnosisInput> second = read_for_diagnosis(long_one, input);
    ASSERT_TRUE(second.ok());
    EXPECT_EQ(second->means->rows(), input.means->rows());
    const Result<DiagnosisInput> brief = read_for_diagnosis(written("brief.csv", "gx_dps", "", 5000), input);
    ASSERT_TRUE(brief.ok());
    EXPECT_EQ(brief->samples->rows(), 5000U);
    EXPECT_EQ(brief->means, nullptr);
    EXPECT_THAT(brief->samples->warnings,
                ElementsAre(HasSubstr("in means of 100 samples it has 50 samples")));
}

// The reference is known for a part of every second.
TEST_F(DiagnosisInputTest, IsWhatTheReferenceKnows) {
    const auto written_with = [&](std::size_t known_of_1000) {
        RecordingInput input{folder_.path("table.csv"), 1000.0, std::nullopt};
        std::ofstream file(input.path);
        file << "gx_dps,ref_x_dps\n";
        for (std::size_t i = 0; i < 10'000; ++i) {
            file << i % 2 << ',' << (i % 1000 < known_of_1000 ? "1" : "") << '\n';
        }
        return input;
    };
    const DiagnosisInput known = read(written_with(800));
    // Without 0.1 s at either end of each, but where the recording itself begins.
    EXPECT_EQ(known.samples->rows(), 10U * 600U + 100U);
    EXPECT_EQ(known.samples->segments.size(), 10U);
    EXPECT_THAT(known.samples->warnings, ElementsAre(HasSubstr("is not known in 2000 of 10000 samples")));

    const Result<DiagnosisInput> hardly = read_for_diagnosis(written_with(400));
    ASSERT_FALSE(hardly.ok());
    EXPECT_THAT(hardly.error().message, HasSubstr("has more missing samples than samples"));
    EXPECT_THAT(hardly.error().message, HasSubstr("is not known in 6000 of 10000 samples"));
}

TEST_F(DiagnosisInputTest, IsTheBeginningOfALongRecordingInMotionWithAWarning) {
    const DiagnosisInput input = read(written("moving.csv", "gx_dps,ref_x_dps", ",1", rows_of_long));
    EXPECT_EQ(input.samples->rows(), resolution::diagnosable_samples_max);
    EXPECT_EQ(input.means, nullptr);
    EXPECT_THAT(input.samples->warnings, ElementsAre(HasSubstr("is looked at from its beginning to 2.5 h")));
}

TEST_F(DiagnosisInputTest, CountsLinesWithoutAGyroAsSamples) {
    const RecordingInput input{folder_.path("holes.csv"), 1000.0, std::nullopt};
    {
        std::ofstream file(input.path);
        file << "gx_dps\n";
        for (std::size_t i = 0; i < rows_of_long; ++i) { file << (i % 8 == 3 ? "nan\n" : "1\n"); }
    }
    const DiagnosisInput holes = read(input);
    EXPECT_LT(holes.samples->rows(), resolution::beginning_max);
    EXPECT_NEAR(holes.samples->duration_s(), 1e-3 * resolution::beginning_max, 0.1);
    ASSERT_NE(holes.means, nullptr);
    EXPECT_EQ(holes.means->rows(), rows_of_long / 100);
}

TEST_F(DiagnosisInputTest, IsTheMeansThatWereAskedFor) {
    RecordingInput input = written("asked.csv", "gx_dps", "", 10000);
    input.samples_per_row = 4;
    EXPECT_EQ(read(input).samples->rows(), 2500U);
    input.samples_per_row = 10;
    const Result<DiagnosisInput> few = read_for_diagnosis(input);
    ASSERT_FALSE(few.ok());
    EXPECT_THAT(few.error().message, HasSubstr("in means of 10 samples it has 1000 samples"));
}

}  // namespace
}  // namespace gyrolog
