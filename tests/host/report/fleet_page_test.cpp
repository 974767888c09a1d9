// The page on the results of many recordings.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "host/app/command_line.hpp"
#include "tests/host/fleet/made_lines.hpp"
#include "tests/host/report/page_reading.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Outcome {
    ExitCode exit_code = ExitCode::ok;
    std::string err;
};

Outcome run(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    const ExitCode exit_code = run_command_line(std::move(arguments), {out, err});
    EXPECT_EQ(out.str(), "");
    return {exit_code, err.str()};
}

// Twelve alike, one with four times the noise, one that could not be read, and the diagnoses of two.
class FleetPageCommand : public testing::Test {
protected:
    void SetUp() override {
        std::ofstream lines(lines_);
        for (int i = 0; i < 13; ++i) {
            MadeUnit unit;
            unit.file = i == 12 ? "odd.csv" : "unit-" + std::to_string(i) + ".csv";
            unit.board = "S" + std::to_string(i);
            unit.bias = 0.1 + 0.01 * i;
            unit.N = i == 12 ? 0.02 : 0.005 + 1e-4 * i;
            lines << analysis_of(unit).dump() << '\n';
        }
        lines << R"({"file": "<b>bad.csv", "exit": 1, "error": "no such <i>file"})" << '\n';
        lines << diagnosis_of("unit-0.csv").dump() << '\n' << diagnosis_of("odd.csv").dump() << '\n';
        std::ofstream(expected_) << "unit-0.csv\nabsent.csv\n";
    }

    TemporaryFolder folder_{TemporaryFolder::Documents::are_wrong_on_purpose};
    std::string lines_ = folder_.path("lines.jsonl");
    std::string expected_ = folder_.path("expected.txt");
    std::string page_ = folder_.path("boards.html");
};

TEST_F(FleetPageCommand, TellsSpreadOutliersCausesAndErrors) {
    const Outcome outcome = run({"report", lines_, "--expected", expected_, "-o", page_});
    ASSERT_EQ(outcome.exit_code, ExitCode::ok) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("written: " + page_));
    const std::string page = read_whole_file(page_);
    EXPECT_THAT(test::unclosed(page), IsEmpty());
    EXPECT_THAT(page, AllOf(HasSubstr("recordings</th><td>15</td>"), HasSubstr("boards</th><td>13</td>"),
                            HasSubstr("no answer</th><td>1</td>"), HasSubstr("other errors</th><td>1</td>"),
                            HasSubstr("verdicts</th><td>partly 2</td>")));
    // The median of 13 values of N is the seventh.
    EXPECT_THAT(page, AllOf(HasSubstr("N, angle random walk, °/s/√Hz"),
                            HasSubstr("x</th><td>13</td>\n<td>0.0056</td>")));
    EXPECT_THAT(page, HasSubstr("odd.csv</th><td>S12</td>\n<td>x</td>\n<td>N</td>\n<td>0.02</td>"));
    EXPECT_THAT(page, HasSubstr("tone</th><td>x</td>\n<td>2 of 2</td>\n<td>62 % (62 to 62)</td>"));
    EXPECT_THAT(page, HasSubstr("rtn</th><td>x, z</td>"));
    EXPECT_THAT(page, AllOf(HasSubstr("&lt;b&gt;bad.csv</th><td>1</td>\n<td>no such &lt;i&gt;file</td>"),
                            HasSubstr("absent.csv</th><td></td>\n<td>no answer</td>")));
    EXPECT_THAT(page, AllOf(Not(HasSubstr("<b>bad")), Not(HasSubstr("href="))));
}

TEST_F(FleetPageCommand, ShowsTheSpreadInItsSection) {
    ASSERT_EQ(run({"report", lines_, "-o", page_}).exit_code, ExitCode::ok);
    const std::string page = read_whole_file(page_);
    const auto sections = test::all_between(page, "How far the units lie apart", "<h2");
    ASSERT_EQ(sections.size(), 1U);
    const auto pictures = test::all_between(sections[0], "base64,", "\"");
    ASSERT_EQ(pictures.size(), 1U);
    EXPECT_EQ(test::all_between(page, "src=", ">").size(), 1U);
    const cv::Mat picture = cv::imdecode(test::from_base64(pictures[0]), cv::IMREAD_COLOR);
    ASSERT_FALSE(picture.empty());
    EXPECT_EQ(picture.cols, 1600);
}

TEST_F(FleetPageCommand, OfFewUnitsSaysWhatIsMissing) {
    std::ofstream(lines_) << analysis_of({}).dump() << '\n';
    const Outcome outcome = run({"report", lines_, "-o", page_});
    ASSERT_EQ(outcome.exit_code, ExitCode::ok) << outcome.err;
    const std::string page = read_whole_file(page_);
    EXPECT_THAT(page, AllOf(HasSubstr("No spread between units can be told."), HasSubstr("1 unit only"),
                            HasSubstr("Every recording has its answer."), Not(HasSubstr("Causes</h2>")),
                            Not(HasSubstr("<img"))));
}

TEST_F(FleetPageCommand, RefusesWhatMakesNoSense) {
    struct Case {
        std::vector<std::string> arguments;
        const char* said;
    };
    for (const Case& one : std::vector<Case>{
             {{lines_, "night.csv", "-o", page_}, "not of both"},
             {{"a.csv", "b.csv", "-o", page_}, "a page is of one recording"},
             {{lines_, "--rate", "100", "-o", page_}, "--rate goes with a recording only"},
             {{"a.csv", "--expected", expected_, "-o", page_}, "--expected goes with results"},
             {{lines_, "-o", "page.pdf"}, "none of the endings of a page"},
             {{lines_, "-o", lines_}, "are the same file"},
         }) {
        std::vector<std::string> arguments{"report"};
        arguments.insert(arguments.end(), one.arguments.begin(), one.arguments.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, ExitCode::usage) << one.said;
        EXPECT_THAT(outcome.err, HasSubstr(one.said));
    }
}

}  // namespace
}  // namespace gyrolog
