// A capture of the virtual board and a simulation of the same model are one signal.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <tuple>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/recording_simulator.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/session/load_capture.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;

json effect(const char* name, const json& params, const json& axes = json::array()) {
    return {{"effect", name}, {"axes", axes}, {"params", params}};
}

// Every kind of effect: on the white noise, on the bias, in the band, in the clock, in reading out.
json model_of_many_effects() {
    json model = json::parse(format_model(typical_mpu9250()));
    model["rate_hz"] = 200.0;
    model["effects"] = {
        effect("arw_scale", {{"factor", 1.7}}, {"x"}),
        effect("bias_step", {{"step_dps", 0.3}, {"at_s", 40.0}}, {"y"}),
        effect("gauss_markov", {{"sigma_dps", 0.05}, {"tau_s", 3.0}}),
        effect("tone", {{"f_hz", 31.0}, {"amplitude_dps", 0.2}}, {"z"}),
        effect("temp_linear", {{"c1_dps_per_C", 0.1}}),
        effect("lowpass", {{"fc_hz", 41.0}}),
        effect("saturation", {{"limit_dps", 0.4}}, {"z"}),
        effect("spikes", {{"per_hour", 600.0}, {"smallest_dps", 1.0}, {"largest_dps", 3.0}}),
        effect("stale", {{"eps", 0.03}}),
        effect("clock_rate", {{"rel", 0.002}}),
        effect("dropped", {{"per_hour", 400.0}}),
    };
    return model;
}

class SimulatedCapture : public testing::Test {
protected:
    void SetUp() override {
        std::ofstream(model_path) << model_of_many_effects();
        const auto read = read_model(model_path);
        ASSERT_TRUE(read.ok()) << read.error().message;
        model = *read;
        SimulationRequest request;
        request.samples = 200 * 150;
        request.seed = 7;
        simulated = simulate_recording(model, request);
    }

    Recording captured() {
        const ProgramResult result =
            run_gyrolog({"capture", "--device", "sim:model=" + model_path + ",seed=7", "--duration", "2m",
                         "--force", "-o", folder.path("a.pcapng")});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        auto capture = load_capture(folder.path("a.pcapng"), true);
        EXPECT_TRUE(capture.ok());
        auto recording = capture->decoder->take_recording("a");
        EXPECT_TRUE(recording.ok());
        return *std::move(recording);
    }

    // Row by row up to the end of the shorter one.
    static void expect_same_counts(const Recording& a, const Recording& b) {
        ASSERT_GT(std::min(a.rows(), b.rows()), 23'000U);
        for (const char* axis : {"gx", "gy", "gz"}) {
            const auto& of_a = std::get<std::vector<std::int16_t>>(a.find(axis)->data);
            const auto& of_b = std::get<std::vector<std::int16_t>>(b.find(axis)->data);
            for (std::size_t i = 0; i < std::min(of_a.size(), of_b.size()); ++i) {
                ASSERT_EQ(of_a[i], of_b[i]) << axis << ", row " << i;
            }
        }
    }

    TemporaryFolder folder;
    std::string model_path = folder.path("model.json");
    SensorModel model;
    Recording simulated;
};

TEST_F(SimulatedCapture, HasTheCountsOfTheSimulationSampleBySample) {
    expect_same_counts(captured(), simulated);
}

// Whatever the rate, the board starts with a filter that leaves a given model's signal as it is.
TEST_F(SimulatedCapture, HasTheCountsOfTheSimulationAtEachRate) {
    for (const double rate_hz : {100.0, 500.0, 1000.0}) {
        SensorModel at_rate = model;
        at_rate.rate_hz = rate_hz;
        std::ofstream(model_path) << format_model(at_rate);
        SimulationRequest request;
        request.samples = static_cast<std::size_t>(rate_hz) * 120;
        request.seed = 7;
        simulated = simulate_recording(at_rate, request);
        const Recording capture = captured();
        for (const char* axis : {"gx", "gy", "gz"}) {
            const auto& a = std::get<std::vector<std::int16_t>>(capture.find(axis)->data);
            const auto& b = std::get<std::vector<std::int16_t>>(simulated.find(axis)->data);
            const std::size_t rows = std::min(a.size(), b.size());
            ASSERT_GT(rows, 11'000U);
            EXPECT_TRUE(std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(rows), b.begin()))
                << axis << " at " << rate_hz << " Hz";
        }
    }
}

// The sensor's filter shows, and the analysis finds the noise before it.
TEST(FilteredCapture, HasTheNoiseOfTheSensorFarBelowTheFilter) {
    constexpr double N_dps = 0.01;  // typical_mpu9250()
    const TemporaryFolder folder;
    for (const auto& [rate, dlpf, variance_share] :
         {std::tuple{"1000", "5", 0.0111}, std::tuple{"1000", "41", 0.0911}, std::tuple{"1000", "184", 0.409},
          std::tuple{"200", "41", 0.455}, std::tuple{"200", "184", 1.0}}) {
        const std::string path = folder.path(std::string(rate) + "-" + dlpf + ".pcapng");
        ASSERT_EQ(run_gyrolog({"capture", "--device", std::string("sim:seed=5,rate=") + rate, "--dlpf", dlpf,
                               "--duration", "20m", "-o", path})
                      .exit_code,
                  0);
        const ProgramResult result = run_gyrolog(
            {"analyze", path, "--json", folder.path("a.json"), "--model", folder.path("model.json")});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        std::ifstream file(folder.path("a.json"));
        const json report = json::parse(file);
        const bool acts = variance_share < 1.0;
        for (const char* axis : {"x", "y", "z"}) {
            const json& of_axis = report["axes"][axis];
            const json& N = of_axis["coefficients"]["N"];
            EXPECT_NEAR(N["value"].get<double>(), N_dps, 4.0 * N["sd"].get<double>()) << rate << ' ' << dlpf;
            EXPECT_LT(N["sd"].get<double>(), 0.02 * N_dps) << rate << ' ' << dlpf;
            // Neighbours, the first point: their differences are less still behind a filter.
            const double first = of_axis["allan"][0]["value"].get<double>();
            const double unfiltered = N_dps * std::sqrt(std::stod(rate));
            if (acts) { EXPECT_LT(first, unfiltered * std::sqrt(variance_share)) << rate << ' ' << dlpf; }
            EXPECT_EQ(of_axis["fit"].contains("bandwidth_hz"), acts) << rate << ' ' << dlpf;
        }
        const std::string text = result.out + result.err;
        EXPECT_EQ(text.find("low-pass filter of") != std::string::npos, acts) << text;
        std::ifstream model_file(folder.path("model.json"));
        EXPECT_EQ(json::parse(model_file)["effects"].size(), acts ? 1U : 0U);
    }
}

TEST_F(SimulatedCapture, IsReadNoFurtherThanWanted) {
    const Recording whole = captured();
    auto capture = load_capture(folder.path("a.pcapng"), true, {}, {5000});
    ASSERT_TRUE(capture.ok());
    const auto beginning = capture->decoder->take_recording("a");
    ASSERT_TRUE(beginning.ok());
    ASSERT_GE(beginning->rows(), 5000U);
    EXPECT_LT(beginning->rows(), 6000U);
    for (std::size_t i = 0; i < beginning->rows(); ++i) {
        ASSERT_EQ(beginning->find("gx")->value(i), whole.find("gx")->value(i)) << i;
    }
}

TEST_F(SimulatedCapture, HasTheSimulationsHolesAndRate) {
    const Recording capture = captured();
    EXPECT_NEAR(capture.rate_hz, 200.0 * 1.002, 200.0 * 2e-6);  // stamps of 1 us over 2 min
    ASSERT_GT(capture.segments.size(), 5U);
    for (std::size_t i = 0; i + 1 < capture.segments.size(); ++i) {
        EXPECT_EQ(capture.segments[i].count, simulated.segments[i].count);
        EXPECT_EQ(capture.segments[i].first_index, simulated.segments[i].first_index);
    }
    // No one counted these losses; the board's clock tells of them.
    ASSERT_EQ(capture.dropouts.size(), capture.segments.size() - 1);
    for (std::size_t i = 0; i < capture.dropouts.size(); ++i) {
        EXPECT_EQ(capture.dropouts[i].cause, "time_stamps");
        if (i < simulated.dropouts.size()) {
            EXPECT_EQ(capture.dropouts[i].samples, simulated.dropouts[i].samples);
            EXPECT_NEAR(capture.dropouts[i].at_s, simulated.dropouts[i].at_s, 1e-3);
        }
    }
}

TEST_F(SimulatedCapture, HasTheCountsThatSimulateWrites) {
    const ProgramResult result =
        run_gyrolog({"simulate", model_path, "-o", folder.path("s.csv"), "--duration", "2m", "--seed", "7"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto written = read_recording_csv(folder.path("s.csv"), {});
    ASSERT_TRUE(written.ok()) << written.error().message;
    const Recording capture = captured();
    ASSERT_GT(written->rows(), 23'000U);
    for (const char* axis : {"gx", "gy", "gz"}) {
        const Column& of_capture = *capture.find(axis);
        const Column& of_text = *written->find(axis);
        for (std::size_t i = 0; i < written->rows(); ++i) {
            // In the model's own step: the board's is told to nine digits, the file's has a thousandth.
            ASSERT_NEAR(of_capture.value(i) / model.lsb_rad_s, of_text.value(i) / model.lsb_rad_s, 0.01)
                << axis << ", row " << i;
        }
    }
}

TEST(CaptureInMeans, IsTheMeansOfWhatIsReadSampleBySample) {
    const TemporaryFolder folder;
    const ProgramResult result =
        run_gyrolog({"capture", "--device", "sim:seed=3,rate=200,fault=drop_packet@7+drop_packet@30",
                     "--duration", "1m", "-o", folder.path("a.pcapng")});
    ASSERT_EQ(result.exit_code, 5) << result.err;  // samples are missing
    auto whole = load_capture(folder.path("a.pcapng"), true);
    ASSERT_TRUE(whole.ok());
    const auto read = whole->decoder->take_recording("a");
    ASSERT_TRUE(read.ok());
    const Recording expected = means_of(*read, 7);
    auto capture = load_capture(folder.path("a.pcapng"), true, {}, {.samples_per_row = 7});
    ASSERT_TRUE(capture.ok());
    const auto means = capture->decoder->take_recording("a");
    ASSERT_TRUE(means.ok());
    EXPECT_EQ(means->samples_per_row, 7U);
    EXPECT_DOUBLE_EQ(means->rate_hz, expected.rate_hz);
    ASSERT_EQ(means->segments.size(), 3U);
    ASSERT_EQ(means->segments.size(), expected.segments.size());
    for (std::size_t i = 0; i < means->segments.size(); ++i) {
        EXPECT_EQ(means->segments[i].first, expected.segments[i].first);
        EXPECT_EQ(means->segments[i].count, expected.segments[i].count);
        EXPECT_EQ(means->segments[i].first_index, expected.segments[i].first_index);
    }
    ASSERT_EQ(means->columns.size(), expected.columns.size());
    for (const Column& column : expected.columns) {
        const Column* mean = means->find(column.name);
        ASSERT_EQ(mean->size(), column.size());
        for (std::size_t i = 0; i < column.size(); ++i) {
            ASSERT_NEAR(mean->value(i), column.value(i), 1e-9 * (1.0 + std::fabs(column.value(i))))
                << column.name << ' ' << i;
        }
    }
}

}  // namespace
}  // namespace gyrolog
