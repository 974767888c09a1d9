// What the commands say fits a terminal of 80 columns.
#include "host/formats/text_width.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/app/command_line.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

namespace fs = std::filesystem;

struct Said {
    std::string out;
    std::string err;
};

Said run(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    const std::string command = arguments.front();
    EXPECT_EQ(run_command_line(std::move(arguments), {out, err}), ExitCode::ok) << command << err.str();
    return {out.str(), err.str()};
}

// A word that is longer stands alone: nobody can break a path or a formula.
std::vector<std::string> too_wide(const std::string& text) {
    std::vector<std::string> found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const bool can_be_broken = line.find(' ', line.find_first_not_of(' ')) != std::string::npos;
        if (width_of(line) > 80 && can_be_broken) { found.push_back(line); }
    }
    return found;
}

// Names are short, as where one works in a folder.
class TextWidth : public testing::Test {
protected:
    static void SetUpTestSuite() {
        before_ = fs::current_path();
        folder_ = std::make_unique<TemporaryFolder>();
        fs::current_path(folder_->path("."));
        run({"capture", "--device", "sim:rate=100,seed=1,dlpf=184", "--duration", "10m", "-o",
             "demo.pcapng"});
        run({"analyze", "demo.pcapng", "--model", "demo.model.json"});
        std::ofstream curve("paper.csv");
        curve << "tau_s,x_dps,y_dps\n";
        for (double tau_s = 0.01; tau_s < 5000.0; tau_s *= 1.5) {
            const double dps = std::hypot(0.01 / std::sqrt(tau_s), 0.002, 2e-5 * std::sqrt(tau_s));
            curve << tau_s << ',' << dps << ',' << dps * (1.0 + 0.3 * std::sin(std::log(tau_s))) << '\n';
        }
    }
    static void TearDownTestSuite() {
        fs::current_path(before_);
        folder_.reset();
    }

    static fs::path before_;
    static std::unique_ptr<TemporaryFolder> folder_;
};

fs::path TextWidth::before_;
std::unique_ptr<TemporaryFolder> TextWidth::folder_;

TEST_F(TextWidth, OfEveryReportIsEightyColumnsAtMost) {
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             {"info", "demo.pcapng"},
             {"check", "demo.pcapng"},
             {"analyze", "demo.pcapng"},
             {"analyze", "--curve", "paper.csv"},
             {"diagnose", "--curve", "paper.csv", "--model", "demo.model.json"},
             {"compare", "demo.pcapng", "demo.pcapng", "--verbose"},
             {"denoise", "demo.pcapng", "--all-methods"},
             {"denoise", "sim:boards=3,rate=200", "--duration", "2m", "--all-methods"},
             {"simulate", "--effects"},
             {"conform", "--device", "sim:"},
         }) {
        EXPECT_THAT(too_wide(run(command).out), testing::IsEmpty()) << command.front();
    }
}

}  // namespace
}  // namespace gyrolog
