// The page that the command writes, with its figures.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "host/app/command_line.hpp"
#include "host/formats/uncertain_number.hpp"
#include "tests/host/report/page_reading.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Outcome {
    ExitCode exit_code = ExitCode::ok;
    std::string out;
    std::string err;
};

Outcome run(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    const ExitCode exit_code = run_command_line(std::move(arguments), {out, err});
    return {exit_code, out.str(), err.str()};
}

// A capture, its analysis, and its pages without and with a model.
class ReportCommand : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        capture_ = folder_->path("run.pcapng");
        model_ = folder_->path("model <b>.json");
        ASSERT_EQ(run({"capture", "--device", "sim:rate=100,seed=7", "--samples", "3000", "-o", capture_})
                      .exit_code,
                  ExitCode::ok);
        std::ofstream(model_) << R"({"schema": "gyrolog-model/1", "rate_hz": 100, "axes": {"x": {"N": 0.01},
                                     "y": {"N": 0.01}, "z": {"N": 0.01}}})";
        analysis_ = json::parse(run({"analyze", capture_, "--json", "-"}).out);
        plain_ = page_of({capture_});
        diagnosed_ = page_of({capture_, "--model", model_, "--simulations", "20"});
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string page_of(std::vector<std::string> arguments) {
        const std::string path = folder_->path("page.html");
        arguments.insert(arguments.begin(), "report");
        arguments.insert(arguments.end(), {"-o", path});
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, ExitCode::ok) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        EXPECT_THAT(outcome.err, HasSubstr("written: " + path));
        return read_whole_file(path);
    }

    static std::unique_ptr<TemporaryFolder> folder_;
    static std::string capture_;
    static std::string model_;
    static json analysis_;
    static std::string plain_;
    static std::string diagnosed_;
};

std::unique_ptr<TemporaryFolder> ReportCommand::folder_;
std::string ReportCommand::capture_;
std::string ReportCommand::model_;
json ReportCommand::analysis_;
std::string ReportCommand::plain_;
std::string ReportCommand::diagnosed_;

TEST_F(ReportCommand, WritesEverySection) {
    for (const char* title :
         {"What was recorded", "What the capture says of itself", "Allan deviation and spectrum of the gyro",
          "Noise coefficients of the gyro", "Bias of the gyro",
          "Allan deviation and spectrum of the accelerometer", "Noise coefficients of the accelerometer",
          "Mean and gravity of the accelerometer", "What to record next"}) {
        EXPECT_THAT(plain_, HasSubstr(fmt::format(">{}</h", title)));
    }
    EXPECT_THAT(plain_, Not(HasSubstr("Against the model")));
    EXPECT_THAT(diagnosed_, AllOf(HasSubstr("Against the model model &lt;b&gt;.json</h2>"),
                                  HasSubstr("class=\"verdict\"")));
    for (const std::string& page : {plain_, diagnosed_}) { EXPECT_THAT(test::unclosed(page), IsEmpty()); }
}

TEST_F(ReportCommand, HasTheNumbersOfTheAnalysis) {
    EXPECT_THAT(plain_, HasSubstr("samples</th><td>3,000</td>"));
    unsigned identified = 0;
    for (const auto& [name, axis] : analysis_["axes"].items()) {
        for (const char* term : {"N", "B", "K", "Q", "R"}) {
            const json& fitted = axis["coefficients"][term];
            const bool is_known = fitted["state"] == "identified";
            identified += is_known ? 1U : 0U;
            const std::string cell = is_known ? with_uncertainty(fitted["value"], fitted["sd"])
                                              : fmt::format("&lt; {:.2g}", fitted["upper"].get<double>());
            EXPECT_THAT(plain_, HasSubstr("<td>" + cell + "</td>")) << term << " of " << name;
        }
        EXPECT_THAT(
            plain_,
            HasSubstr("<td>" + with_uncertainty(axis["bias"]["value"], axis["bias"]["expanded_uncertainty"]) +
                      "</td>"))
            << name;
    }
    EXPECT_GE(identified, 3U) << "the recording does not even tell N";
}

TEST_F(ReportCommand, HasTheAccelerometerInItsOwnUnits) {
    const json& accelerometer = analysis_["accelerometer"];
    for (const auto& [name, axis] : accelerometer["axes"].items()) {
        const json& N = axis["coefficients"]["N"];
        ASSERT_EQ(N["state"], "identified") << name;
        EXPECT_THAT(
            plain_,
            HasSubstr("<td>" + with_uncertainty(1e6 * N["value"].get<double>(), 1e6 * N["sd"].get<double>()) +
                      "</td>"))
            << name;
        const json& mean = axis["mean"];
        EXPECT_THAT(plain_, HasSubstr(with_uncertainty(mean["value"], mean["expanded_uncertainty"])));
    }
    EXPECT_THAT(plain_, AllOf(HasSubstr("accelerometer axes</th><td>x, y, z</td>"), HasSubstr(">µg/√Hz</th>"),
                              HasSubstr(">m/s/√h</th>"), HasSubstr("velocity random walk"),
                              HasSubstr("the velocity is off by")));
    const json& size = accelerometer["gravity"]["size"];
    EXPECT_THAT(plain_,
                HasSubstr("<td>" + with_uncertainty(size["value"], size["expanded_uncertainty"]) + "</td>"));
    EXPECT_THAT(plain_, AllOf(HasSubstr("<td>+z</td>"), HasSubstr(">tilt, °</th>")));
}

TEST_F(ReportCommand, ReportsAnAccelerometerAlone) {
    const std::string path = folder_->path("acc.csv");
    std::ofstream text(path);
    text << "t_s,ax_g,ay_g,az_g\n";
    unsigned state = 1;
    const auto noise_g = [&] {
        state = state * 1664525U + 1013904223U;
        return static_cast<double>(state >> 16U) * 1e-7;
    };
    for (int i = 0; i < 1000; ++i) {
        text << i / 100.0 << ',' << noise_g() << ',' << noise_g() << ',' << 1.0 + noise_g() << '\n';
    }
    text.close();
    const std::string page = page_of({path});
    EXPECT_THAT(page, AllOf(HasSubstr("Mean and gravity of the accelerometer</h2>"), HasSubstr("µg/√Hz"),
                            Not(HasSubstr("gyro axes")), Not(HasSubstr("Bias</h2>"))));
    EXPECT_THAT(test::unclosed(page), IsEmpty());
}

// Nothing that a browser would go and get, and nothing that it would run.
TEST_F(ReportCommand, StandsByItself) {
    for (const std::string& page : {plain_, diagnosed_}) {
        for (const char* word :
             {"http:", "https:", "<script", "<link", "<iframe", "@import", "url(", "href="}) {
            EXPECT_THAT(page, Not(HasSubstr(word)));
        }
        for (const std::string& source : test::all_between(page, "src=", ">")) {
            EXPECT_TRUE(source.starts_with("\"data:image/png;base64,")) << source.substr(0, 100);
        }
    }
}

TEST_F(ReportCommand, HasPicturesThatShowSomething) {
    const auto expect_pictures = [](const std::string& page, std::size_t count) {
        const auto texts = test::all_between(page, "base64,", "\"");
        EXPECT_EQ(texts.size(), count);
        for (const std::string& text : texts) {
            const cv::Mat picture = cv::imdecode(test::from_base64(text), cv::IMREAD_GRAYSCALE);
            ASSERT_FALSE(picture.empty());
            EXPECT_EQ(picture.cols, 1600);
            // Lines and letters are a hundredth of it at least.
            const std::ptrdiff_t dark =
                std::count_if(picture.begin<std::uint8_t>(), picture.end<std::uint8_t>(),
                              [](std::uint8_t level) { return level < 200; });
            EXPECT_GT(static_cast<double>(dark), 0.01 * static_cast<double>(picture.total()));
        }
    };
    // Of two sensors each: deviation, spectrum, the samples of three axes, and the course over
    // time and over the temperature.
    expect_pictures(plain_, 14);
    expect_pictures(diagnosed_, 15);
}

TEST_F(ReportCommand, TellsTheBoardOfACapture) {
    EXPECT_THAT(plain_, AllOf(HasSubstr("board</th><td>"), HasSubstr("firmware</th><td>"),
                              HasSubstr("started</th><td>2"), HasSubstr("MPU-9250")));
}

TEST_F(ReportCommand, ListsTheHolesAndTheTemperaturesOfText) {
    const std::string path = folder_->path("<i>&holes.csv");
    std::ofstream text(path);
    text << "t_s,gx_dps,temp_C\n";
    unsigned state = 1;
    for (int i = 0; i < 600; ++i) {
        state = state * 1664525U + 1013904223U;
        if (i >= 200 && i < 203) { continue; }
        text << i / 100.0 << ',' << (state >> 16) % 1000 << ',' << 20.0 + i / 100.0 << '\n';
    }
    text.close();
    const std::string page = page_of({path});
    EXPECT_THAT(page, HasSubstr("3 samples in 1 dropout"));
    EXPECT_THAT(page, HasSubstr("2.000 s</th><td>3</td>\n<td>time_stamps</td>"));
    EXPECT_THAT(page, HasSubstr("20.00 °C to 25.99 °C"));
    EXPECT_THAT(page, AllOf(HasSubstr("<h1>&lt;i&gt;&amp;holes.csv</h1>"), Not(HasSubstr("<i>"))));
    EXPECT_THAT(page, HasSubstr("mean rate over temperature"));
}

TEST_F(ReportCommand, RefusesWhatMakesNoSense) {
    const std::string page = folder_->path("refused.html");
    const std::string bad = folder_->path("bad.csv");
    std::ofstream(bad) << "t_s,gx_dps\n0,1\n1,two\n";
    const std::string no_stamps = folder_->path("nostamps.csv");
    std::ofstream(no_stamps) << "gx_dps\n1\n2\n3\n";
    struct Case {
        std::vector<std::string> arguments;
        ExitCode exit_code;
        const char* said;
    };
    for (const Case& one : std::vector<Case>{
             {{}, ExitCode::usage, "RECORDING is required"},
             {{capture_}, ExitCode::usage, "--output is required"},
             {{capture_, "-o", "page.pdf"},
              ExitCode::usage,
              "'page.pdf' has none of the endings of a page: .html"},
             {{capture_, "-o", "-"}, ExitCode::usage, "--output '-': only --json goes to standard output"},
             {{capture_, "-o", capture_}, ExitCode::usage, "RECORDING and --output are the same file"},
             {{capture_, "--model", model_, "-o", model_},
              ExitCode::usage,
              "--model and --output are the same"},
             {{capture_, "-o", page, "--simulations", "20"},
              ExitCode::usage,
              "--simulations requires --model"},
             {{capture_, "-o", page, "--model", model_, "--simulations", "2"},
              ExitCode::usage,
              "whole number from 20"},
             {{capture_, "-o", folder_->path("no/page.html")}, ExitCode::failed, "no such directory"},
             {{capture_, "-o", page, "--model", bad}, ExitCode::failed, "bad.csv': no JSON: line 1"},
             {{bad, "-o", page}, ExitCode::failed, "line 3, column 'gx_dps': 'two' is no number"},
             {{no_stamps, "-o", page}, ExitCode::usage, "give the sampling rate with --rate"},
             {{folder_->path("none.csv"), "-o", page}, ExitCode::failed, "none.csv': no such file"},
         }) {
        std::vector<std::string> arguments{"report"};
        arguments.insert(arguments.end(), one.arguments.begin(), one.arguments.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, one.exit_code) << one.said;
        EXPECT_THAT(outcome.err, HasSubstr(one.said));
        EXPECT_EQ(outcome.out, "");
        EXPECT_FALSE(std::filesystem::exists(page)) << one.said;
    }
}

}  // namespace
}  // namespace gyrolog
