// Curves from print and exports through the whole program: files, exit codes, messages.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/needs.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string write_curve(const TemporaryFolder& folder) {
    const std::string path = folder.path("curve.csv");
    std::ofstream text(path);
    text << "tau_s,x_dps,z_deg_per_h\n";
    for (double tau_s = 0.01; tau_s < 2000.0; tau_s *= 1.5) {
        const double variance = 1e-4 / tau_s + 1e-8 * tau_s / 3.0;
        text << tau_s << ',' << std::sqrt(variance) << ',' << 3600.0 * 2.0 * std::sqrt(variance) << '\n';
    }
    return path;
}

std::string write_recording(const TemporaryFolder& folder) {
    const std::string path = folder.path("run.csv");
    std::ofstream text(path);
    text << "t_s,gx_dps,gy_dps\n";
    unsigned state = 1;
    for (int i = 0; i < 3000; ++i) {
        state = state * 1664525U + 1013904223U;
        text << i / 100.0 << ',' << (state >> 16) % 1000 << ',' << (state >> 20) % 1000 << '\n';
    }
    return path;
}

TEST(Curve, GivesReportPlotAndAModelThatTheVirtualBoardPlays) {
    const TemporaryFolder folder;
    const std::string model = folder.path("model.json");
    const ProgramResult result =
        run_gyrolog({"analyze", "--curve", write_curve(folder), "--json", folder.path("a.json"), "--plot",
                     folder.path("a.png"), "--model", model, "--rate", "100"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("N B K"));
    EXPECT_THAT(result.err, HasSubstr("no curve of axis y"));
    EXPECT_GT(std::filesystem::file_size(folder.path("a.png")), 10000U);
    const json report = json::parse(read_whole_file(folder.path("a.json")));
    EXPECT_NEAR(report["axes"]["x"]["coefficients"]["N"]["value"].get<double>(), 0.01, 1e-4);
    EXPECT_NEAR(report["axes"]["z"]["coefficients"]["K"]["value"].get<double>(), 2e-4, 2e-6);
    const ProgramResult played = run_gyrolog({"capture", "--device", "sim:rate=100,model=" + model,
                                              "--samples", "1000", "-o", folder.path("played.pcapng")});
    EXPECT_EQ(played.exit_code, 0) << played.err;
}

TEST(Curve, AndRecordingExcludeEachOther) {
    const TemporaryFolder folder;
    const std::string curve = write_curve(folder);
    const ProgramResult both = run_gyrolog({"analyze", write_recording(folder), "--curve", curve});
    EXPECT_EQ(both.exit_code, 2);
    EXPECT_EQ(both.err, "gyrolog analyze: give a RECORDING or --curve, not both\n");
    const ProgramResult neither = run_gyrolog({"analyze"});
    EXPECT_EQ(neither.exit_code, 2);
    EXPECT_EQ(neither.err, "gyrolog analyze: give a RECORDING, or --curve with an Allan curve\n");
    EXPECT_EQ(run_gyrolog({"analyze", "--curve", curve, "--m", "1,2"}).exit_code, 2);
    EXPECT_EQ(run_gyrolog({"analyze", "--curve", folder.path("none.csv")}).exit_code, 1);
}

TEST(Export, WritesEveryFormatByTheFilesEnding) {
    const TemporaryFolder folder;
    const std::string recording = write_recording(folder);
    for (const char* name : {"a.csv.gz", "a.mat", "a.yaml", "a.m", "a.tuning.json"}) {
        const ProgramResult result = run_gyrolog({"export", recording, "-o", folder.path(name)});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_GT(std::filesystem::file_size(folder.path(name)), 100U) << name;
    }
    const ProgramResult unknown = run_gyrolog({"export", recording, "-o", folder.path("a.docx")});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_THAT(unknown.err, HasSubstr(".yaml"));
}

TEST(Export, OfAModelGivesItsNoiseAndNoSamples) {
    const TemporaryFolder folder;
    const std::string model = folder.path("model.json");
    ASSERT_EQ(
        run_gyrolog({"analyze", "--curve", write_curve(folder), "--model", model, "--rate", "100"}).exit_code,
        0);
    ASSERT_EQ(run_gyrolog({"export", model, "-o", folder.path("imu.yaml")}).exit_code, 0);
    EXPECT_THAT(read_whole_file(folder.path("imu.yaml")), HasSubstr("\ngyroscope_noise_density: 0.00034"));
    const ProgramResult samples = run_gyrolog({"export", model, "-o", folder.path("imu.csv")});
    EXPECT_EQ(samples.exit_code, 2);
    EXPECT_THAT(samples.err, HasSubstr("a model has no samples"));
}

TEST(Export, OfAModelTakesItsRateFromTheOptionAndTellsTheModelsNotes) {
    const TemporaryFolder folder;
    const std::string model = folder.path("robot.sdf");
    std::ofstream(model) << "<sdf version='1.9'><sensor name='imu' type='imu'><imu><angular_velocity>"
                            "<x><noise type='gaussian'><stddev>0.01</stddev></noise></x>"
                            "</angular_velocity></imu></sensor></sdf>";
    const std::string simulator = folder.path("out.sdf");
    const std::string filter = folder.path("imu.yaml");
    for (const std::vector<std::string>& to :
         {std::vector<std::string>{"--for", "sdf", "-o", simulator}, {"-o", filter}}) {
        std::vector<std::string> command = {"export", model};
        command.insert(command.end(), to.begin(), to.end());
        const ProgramResult without = run_gyrolog(command);
        EXPECT_EQ(without.exit_code, 1);
        EXPECT_THAT(without.err, HasSubstr("give --rate"));
        command.insert(command.end(), {"--rate", "400"});
        const ProgramResult with = run_gyrolog(command);
        EXPECT_EQ(with.exit_code, 0) << with.err;
        EXPECT_THAT(with.err, HasSubstr("the model is taken from an imu sensor of SDF"));
    }
    EXPECT_THAT(read_whole_file(simulator), HasSubstr("<update_rate>400</update_rate>"));
    EXPECT_THAT(read_whole_file(filter), HasSubstr("\ngyroscope_noise_density: 0.0005\n"));
}

TEST(Analyze, WritesAFigureInTheFormOfItsEnding) {
    const TemporaryFolder folder;
    const std::string recording = write_recording(folder);
    for (const auto& [name, head] : {std::pair{"a.svg", "<?xml"}, {"a.pdf", "%PDF-"}, {"a.PNG", "\x89PNG"}}) {
        const ProgramResult result = run_gyrolog({"analyze", recording, "--plot", folder.path(name)});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(read_whole_file(folder.path(name)).starts_with(head)) << name;
    }
}

// Of a PNG: big-endian, behind the name of its first piece.
std::uint32_t width_px_in(const std::string& png) {
    std::uint32_t width = 0;
    for (const char byte : png.substr(16, 4)) { width = width << 8U | static_cast<unsigned char>(byte); }
    return width;
}

TEST(Analyze, DrawsAFigureOfTheWidthOnPaperThatWasAskedFor) {
    const TemporaryFolder folder;
    const std::string recording = write_recording(folder);
    const auto drawn = [&](const char* name, std::vector<std::string> how) {
        std::vector<std::string> command{"analyze", recording, "--plot", folder.path(name)};
        command.insert(command.end(), how.begin(), how.end());
        const ProgramResult result = run_gyrolog(command);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_whole_file(folder.path(name));
    };
    EXPECT_EQ(width_px_in(drawn("a.png", {})), 2126U) << "180 mm, 300 to the inch";
    EXPECT_EQ(width_px_in(drawn("b.png", {"--plot-width", "120", "--plot-dpi", "150"})), 709U);
    EXPECT_THAT(drawn("c.svg", {"--plot-width", "254"}).substr(0, 300), HasSubstr("width=\"720pt\""));
}

TEST(Analyze, RefusesAFigureOfAnotherForm) {
    const TemporaryFolder folder;
    const std::string plot = folder.path("a.jpg");
    const ProgramResult result = run_gyrolog({"analyze", write_recording(folder), "--plot", plot});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("a figure has no other form"));
    EXPECT_FALSE(std::filesystem::exists(plot));
}

TEST(Analyze, AFullDiskIsTheSameForTextAndJson) {
    if (!has_full_disk()) { GTEST_SKIP() << needs_full_disk; }
    const TemporaryFolder folder;
    const std::string recording = write_recording(folder);
    const std::string program =
        std::string(std::getenv("GYROLOG_BUILD_DIR")) + "/gyrolog analyze " + recording;
    const int text = std::system((program + " >/dev/full 2>/dev/null").c_str());
    const int json_out = std::system((program + " --json - >/dev/full 2>/dev/null").c_str());
    EXPECT_EQ(WEXITSTATUS(text), 6);
    EXPECT_EQ(WEXITSTATUS(json_out), 6);
}

TEST(CaptureOptions, CountsAndRatesOfNothingAreRefusedInPlainWords) {
    for (const auto& [option, words] : {std::pair{"--samples", "--samples: '0' is no whole number from 1 to"},
                                        std::pair{"--rate", "--rate: 0 must be a finite number above 0"}}) {
        const ProgramResult result =
            run_gyrolog({"capture", "-o", "x.pcapng", "--device", "sim:", option, "0"});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_THAT(result.err, HasSubstr(words));
    }
}

}  // namespace
}  // namespace gyrolog
