#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/simulate/counter_random.hpp"
#include "host/app/command_line.hpp"
#include "host/app/live_denoise.hpp"
#include "host/capture/capture_reader.hpp"
#include "host/capture/segment_files.hpp"
#include "host/decode/stream_decoder.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr std::size_t rows = 6000;
constexpr std::size_t still_rows = 3000;
constexpr double rate_hz = 200.0;

// Units of 0.2 dps a sample, 0.1 dps apart; a quarter of a minute each at rest and swinging.
Recording array_of(std::size_t units, std::uint64_t seed = 1) {
    Recording recording;
    recording.rate_hz = rate_hz;
    recording.segments = {{0, rows, 0}};
    std::vector<double> reference(rows, 0.0);
    for (std::size_t i = still_rows; i < rows; ++i) {
        reference[i] =
            5.0 * std::sin(6.283185307179586 * 0.3 * static_cast<double>(i - still_rows) / rate_hz);
    }
    for (std::size_t unit = 0; unit < units; ++unit) {
        std::vector<double> x(rows);
        RandomStream(seed, static_cast<std::uint32_t>(unit)).normals(0, x);
        for (std::size_t i = 0; i < rows; ++i) {
            x[i] = 0.2 * x[i] + reference[i] + 0.1 * static_cast<double>(unit);
        }
        recording.columns.push_back(
            {units == 1 ? "gx" : "gx" + std::to_string(unit + 1), "rad/s", x, rad_per_deg, 0.0, "dps"});
    }
    recording.columns.push_back({"ref_x", "rad/s", reference, rad_per_deg, 0.0, "dps"});
    return recording;
}

class DenoiseCommand : public testing::Test {
protected:
    void SetUp() override { ASSERT_TRUE(write_recording_csv(array_of(3), recording).ok()); }

    ExitCode denoise(std::vector<std::string> arguments) {
        out.str("");
        err.str("");
        arguments.insert(arguments.begin(), "denoise");
        return run_command_line(std::move(arguments), {out, err});
    }
    Recording read(const std::string& path) const {
        auto result = read_recording_csv(path, {});
        EXPECT_TRUE(result.ok());
        return result.ok() ? std::move(result).value() : Recording{};
    }

    TemporaryFolder folder;
    std::string recording = folder.path("array.csv");
    std::string fused = folder.path("fused.csv");
    std::ostringstream out;
    std::ostringstream err;
};

TEST_F(DenoiseCommand, WritesTheFusedRateReportAndFigure) {
    EXPECT_EQ(denoise({recording, "-o", fused, "--all-methods", "--json", folder.path("d.json"), "--plot",
                       folder.path("d.png")}),
              ExitCode::ok)
        << err.str();
    EXPECT_THAT(out.str(), HasSubstr("their plain mean"));
    EXPECT_EQ(read_whole_file(folder.path("d.png")).substr(1, 3), "PNG");
    const json answer = json::parse(read_whole_file(folder.path("d.json")));
    EXPECT_EQ(answer["schema"], "gyrolog-denoise/1");
    EXPECT_EQ(answer["method"], "joint");
    EXPECT_LT(answer["still"]["to_s"], 17.0);
    EXPECT_GT(answer["still"]["to_s"], 13.0);
    const json& x = answer["axes"]["x"];
    EXPECT_EQ(x["units"].size(), 3U);
    EXPECT_GT(x["methods"]["joint"]["reduction"], x["methods"]["wavelet"]["reduction"]);
    EXPECT_NEAR(x["methods"]["kalman"]["reduction"].get<double>(), 3.0, 0.5);
    EXPECT_LT(x["methods"]["joint"]["motion"]["error_variance"], x["first_unit_motion"]["error_variance"]);
    const Recording result = read(fused);
    ASSERT_EQ(result.columns.size(), 2U);
    EXPECT_EQ(result.columns[0].name, "gx");
    EXPECT_EQ(result.columns[0].source_unit, "dps");
    EXPECT_EQ(result.columns[1].name, "ref_x");
    EXPECT_EQ(result.rows(), rows);
    EXPECT_NEAR(result.t_s[100], 0.5, 1e-9);
}

TEST_F(DenoiseCommand, OneUnitAndNoWaveletIsTheIdentity) {
    const std::string one = folder.path("one.csv");
    const Recording before = array_of(1);
    ASSERT_TRUE(write_recording_csv(before, one).ok());
    ASSERT_EQ(denoise({one, "-o", fused, "--method", "kalman"}), ExitCode::ok) << err.str();
    const Recording after = read(fused);
    for (std::size_t i = 0; i < rows; ++i) {
        ASSERT_NEAR(after.columns[0].value(i), before.columns[0].value(i), 1e-10) << i;
    }
}

TEST_F(DenoiseCommand, SeveralRecordingsAreTheArrayThatOneWouldBe) {
    const Recording whole = array_of(3);
    for (std::size_t unit = 0; unit < 3; ++unit) {
        Recording alone = whole;
        alone.columns = {whole.columns[unit], whole.columns[3]};
        alone.columns.front().name = "gx";
        ASSERT_TRUE(write_recording_csv(alone, folder.path(std::to_string(unit) + ".csv")).ok());
    }
    ASSERT_EQ(denoise({recording, "-o", fused}), ExitCode::ok) << err.str();
    ASSERT_EQ(denoise({folder.path("0.csv"), folder.path("1.csv"), folder.path("2.csv"), "-o",
                       folder.path("joined.csv")}),
              ExitCode::ok)
        << err.str();
    EXPECT_EQ(read_whole_file(fused), read_whole_file(folder.path("joined.csv")));
}

TEST_F(DenoiseCommand, AVirtualArrayIsDenoisedByItself) {
    ASSERT_EQ(
        denoise({"sim:boards=3,rate=200,seed=5", "--duration", "20s", "--method", "kalman", "--json", "-"}),
        ExitCode::ok)
        << err.str();
    const json answer = json::parse(out.str());
    EXPECT_EQ(answer["axes"].size(), 3U);
    EXPECT_EQ(answer["samples"], 4000);
    for (const auto& axis : answer["axes"]) {
        EXPECT_EQ(axis["units"].size(), 3U);
        EXPECT_NEAR(axis["methods"]["kalman"]["reduction"].get<double>(), 3.0, 0.4);
    }
}

TEST_F(DenoiseCommand, ReadsModelsInPlaceOfFits) {
    SensorModel quiet = typical_mpu9250();
    SensorModel loud = typical_mpu9250();
    for (AxisModel& axis : loud.axes) { axis.noise.N_rad_per_sqrt_s *= 10.0; }
    ASSERT_TRUE(write_model(quiet, folder.path("quiet.json")).ok());
    ASSERT_TRUE(write_model(loud, folder.path("loud.json")).ok());
    ASSERT_EQ(denoise({recording, "--method", "kalman", "--model", folder.path("quiet.json"), "--model",
                       folder.path("loud.json"), "--model", folder.path("loud.json"), "--json", "-"}),
              ExitCode::ok)
        << err.str();
    EXPECT_GT(json::parse(out.str())["axes"]["x"]["units"][0]["weight"], 0.9);
    EXPECT_EQ(denoise({recording, "--model", folder.path("quiet.json"), "--model", folder.path("loud.json")}),
              ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("2 models for 3 units"));
}

TEST_F(DenoiseCommand, SaysWhatIsWrong) {
    EXPECT_EQ(denoise({recording, "--still", "120"}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("FROM,TO"));
    EXPECT_EQ(denoise({recording, "--still", "900,1000"}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("it lasts 30 s"));
    EXPECT_EQ(denoise({recording, "--still", "0,1000"}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("--still 0,1000: the recording lasts only 30 s"));
    EXPECT_EQ(denoise({recording, "-o", folder.path("fused.mat")}), ExitCode::usage);
    EXPECT_EQ(denoise({recording, "-o", recording}), ExitCode::usage);
    EXPECT_EQ(denoise({recording, "--method", "wavelet", "--bandwidth", "5"}), ExitCode::usage);
    EXPECT_EQ(denoise({recording, "--bandwidth", "99"}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("0.45 of the rate"));
    EXPECT_EQ(denoise({folder.path("none.csv")}), ExitCode::failed);
    std::ofstream(folder.path("bad.csv")) << "t_s,gx1_dps\n0,1\n0.1,x\n";
    EXPECT_EQ(denoise({folder.path("bad.csv")}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("line 3"));
    EXPECT_EQ(denoise({"sim:boards=2", recording}), ExitCode::usage);
}

TEST_F(DenoiseCommand, LeavesAFailingUnitOutAndSaysSo) {
    Recording array = array_of(3);
    auto& second = std::get<std::vector<double>>(array.columns[1].data);
    for (std::size_t i = 4000; i < 5000; ++i) { second[i] = 0.0; }
    ASSERT_TRUE(write_recording_csv(array, recording).ok());
    ASSERT_EQ(denoise({recording, "--method", "kalman"}), ExitCode::ok) << err.str();
    EXPECT_THAT(out.str(), HasSubstr("unit 2 stuck, left out from 20"));
}

class LiveDenoising : public DenoiseCommand {
protected:
    ExitCode capture(const std::string& device, std::vector<std::string> arguments) {
        err.str("");
        arguments.insert(arguments.begin(), {"capture", "--device", device, "-o", stored, "--force"});
        return run_command_line(std::move(arguments), {out, err});
    }
    // What the summary says gives the same.
    std::vector<std::string> said_arguments() const {
        const std::string text = err.str();
        const std::string before = "the same afterwards: gyrolog denoise ";
        const std::size_t at = text.find(before);
        if (at == std::string::npos) { return {}; }
        std::istringstream words(text.substr(at + before.size(), text.find('\n', at) - at - before.size()));
        return {std::istream_iterator<std::string>(words), {}};
    }

    std::string stored = folder.path("a.pcapng");
    std::string live = folder.path("a.denoised.csv");
};

TEST_F(LiveDenoising, WritesWhatDenoiseWritesAfterwards) {
    // Holes, one of them while the noise is learned.
    const std::string device = "sim:rate=200,seed=7,fault=fifo_overflow@5+drop_packet@12+link_stall@15..17";
    const std::vector<std::vector<std::string>> choices{
        {"wavelet"}, {"joint"}, {"kalman", "--bandwidth", "5"}};
    for (const std::vector<std::string>& choice : choices) {
        std::vector<std::string> arguments{"--duration", "25s", "--denoise"};
        arguments.insert(arguments.end(), choice.begin(), choice.end());
        ASSERT_EQ(capture(device, arguments), ExitCode::data_lost) << err.str();
        EXPECT_THAT(err.str(), HasSubstr("noise of 0 s to 10"));
        std::vector<std::string> again = said_arguments();
        EXPECT_THAT(again, testing::Contains("--still"));
        again.insert(again.end(), {"-o", fused});
        ASSERT_EQ(denoise(again), ExitCode::ok) << err.str();
        EXPECT_GT(read(live).rows(), 4500U);
        EXPECT_TRUE(read_whole_file(live) == read_whole_file(fused)) << choice.front();
    }
}

TEST_F(LiveDenoising, OneGyroIsWhatItWasByKalmanAndQuieterByJoint) {
    const std::string device = "sim:rate=200,seed=7";
    ASSERT_EQ(capture(device, {"--duration", "12s", "--denoise", "kalman"}), ExitCode::ok) << err.str();
    EXPECT_THAT(err.str(), HasSubstr("kalman has nothing to combine"));
    const Recording same = read(live);
    ASSERT_EQ(run_command_line({"export", stored, "-o", fused}, {out, err}), ExitCode::ok) << err.str();
    const Recording raw = read(fused);
    ASSERT_EQ(same.rows(), raw.rows());
    for (std::size_t i = 0; i < raw.rows(); ++i) {
        ASSERT_NEAR(same.find("gz")->value(i), raw.find("gz")->value(i), 1e-6) << i;
    }
    ASSERT_EQ(capture(device, {"--duration", "12s", "--denoise", "joint", "--denoise-out", fused}),
              ExitCode::ok)
        << err.str();
    const auto change = [](const Recording& of) {
        double sum = 0.0;
        for (std::size_t i = 1; i < of.rows(); ++i) {
            sum += std::abs(of.find("gz")->value(i) - of.find("gz")->value(i - 1));
        }
        return sum;
    };
    EXPECT_LT(change(read(fused)), 0.2 * change(raw));
}

// The one pause of a stored capture's board, from its last instant to its next, by what the clocks say.
class PauseByTheClocks final : private MessageHandler {
public:
    explicit PauseByTheClocks(const std::string& capture) {
        for (const std::string& file : segment_files(capture)) {
            auto reader = CaptureReader::open(file);
            if (!reader.ok()) {
                ADD_FAILURE() << reader.error().message;
                return;
            }
            if (before_) { decoder_.begin_connection(); }
            while (true) {
                const auto captured = reader->next();
                if (!captured.ok() || !*captured) { break; }
                static_cast<void>(decoder_.take((*captured)->transfer));
            }
        }
        in_the_end_s_ = pause_s();
    }

    double at_its_first_frame_s() const { return at_its_first_frame_s_; }
    double in_the_end_s() const { return in_the_end_s_; }

private:
    struct Instant {
        std::uint32_t run;
        std::uint64_t index;
    };

    void on_samples(const ReceivedFrame& /*frame*/, const glp_samples& samples) override {
        const std::uint32_t run = decoder_.run();
        if (!before_ || before_->run == run) {
            before_ = {run, samples.first_index + samples.count};
        } else if (!after_) {
            after_ = {run, samples.first_index};
            at_its_first_frame_s_ = pause_s();
        }
    }
    double pause_s() const {
        if (!before_ || !after_) { return 0.0; }
        const SampleTimeline& timeline = decoder_.timeline();
        const double from_s = timeline.device_time_s(before_->run, before_->index, rate_hz).value_or(0.0);
        return std::max(timeline.device_time_s(after_->run, after_->index, rate_hz).value_or(0.0) - from_s,
                        0.0);
    }

    StreamDecoder decoder_{{.keep_samples = false, .observer = this}};
    std::optional<Instant> before_;
    std::optional<Instant> after_;
    double at_its_first_frame_s_ = 0.0;
    double in_the_end_s_ = 0.0;
};

double longest_pause_s(const Recording& recording) {
    double longest_s = 0.0;
    for (std::size_t i = 1; i < recording.rows(); ++i) {
        longest_s = std::max(longest_s, recording.t_s[i] - recording.t_s[i - 1] - 1.0 / rate_hz);
    }
    return longest_s;
}

TEST_F(LiveDenoising, GoesOnOverAPauseOfTheBoard) {
    for (const char* how : {"", ",reset=15"}) {
        const std::string device = *how == '\0' ? "sim:rate=200,seed=7,unplug=15,replug=17"
                                                : std::string("sim:rate=200,seed=7") + how;
        ASSERT_EQ(capture(device, {"--duration", "25s", "--denoise", "joint"}), ExitCode::data_lost)
            << err.str();
        std::vector<std::string> again = said_arguments();
        again.insert(again.end(), {"-o", fused});
        ASSERT_EQ(denoise(again), ExitCode::ok) << err.str();
        const Recording as_it_came = read(live);
        const Recording afterwards = read(fused);
        ASSERT_EQ(as_it_came.rows(), afterwards.rows()) << device;
        EXPECT_GT(afterwards.rows(), 4000U) << device;
        for (std::size_t i = 0; i < afterwards.rows(); ++i) {
            ASSERT_NEAR(as_it_came.find("gz")->value(i), afterwards.find("gz")->value(i), 1e-6)
                << device << i;
        }
        // A virtual board that does not wait for the clock sends 32 frames of samples in no time.
        const PauseByTheClocks pause(stored);
        EXPECT_GT(pause.at_its_first_frame_s(), pause.in_the_end_s()) << device << ": this test tests little";
        constexpr double one_instant_s = 1.0 / rate_hz;
        EXPECT_NEAR(longest_pause_s(as_it_came), pause.at_its_first_frame_s(), one_instant_s) << device;
        EXPECT_NEAR(longest_pause_s(afterwards), pause.in_the_end_s(), one_instant_s) << device;
        EXPECT_TRUE(std::ranges::is_sorted(as_it_came.t_s)) << device;
    }
}

TEST_F(LiveDenoising, TakesAModelWhereNothingRests) {
    ASSERT_TRUE(write_model(typical_mpu9250(), folder.path("known.json")).ok());
    json moving = json::parse(format_model(typical_mpu9250()));
    moving["rate_hz"] = 100.0;
    moving["effects"] = {
        {{"effect", "gauss_markov"}, {"axes", json::array()}, {"params", {{"sigma_dps", 20}, {"tau_s", 1}}}}};
    std::ofstream(folder.path("moving.json")) << moving;
    const std::string device = "sim:model=" + folder.path("moving.json") + ",seed=3";

    EXPECT_EQ(capture(device, {"--duration", "70s", "--denoise", "joint"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("did not rest for 10 s in its first 60 s"));
    EXPECT_EQ(read_whole_file(live), "");
    EXPECT_EQ(run_command_line({"check", stored}, {out, err}), ExitCode::ok);

    const std::string model = folder.path("known.json");
    ASSERT_EQ(capture(device, {"--duration", "70s", "--denoise", "joint", "--denoise-model", model}),
              ExitCode::ok)
        << err.str();
    std::vector<std::string> again = said_arguments();
    again.insert(again.end(), {"-o", fused});
    ASSERT_EQ(denoise(again), ExitCode::ok) << err.str();
    EXPECT_EQ(read(live).rows(), 7000U);
    EXPECT_TRUE(read_whole_file(live) == read_whole_file(fused));
}

TEST_F(LiveDenoising, RefusesWhatItCannotDo) {
    EXPECT_EQ(capture("sim:boards=2,rate=200", {"--duration", "1s", "--denoise", "joint"}), ExitCode::usage);
    EXPECT_THAT(err.str(), HasSubstr("gyrolog denoise A.pcapng B.pcapng"));
    EXPECT_EQ(capture("sim:rate=200", {"--duration", "1s", "--bandwidth", "5"}), ExitCode::usage);
    EXPECT_EQ(capture("sim:rate=200", {"--duration", "1s", "--denoise", "joint", "--denoise-out", stored}),
              ExitCode::usage);
    const std::string none = folder.path("none");
    EXPECT_EQ(capture("sim:rate=200", {"--duration", "1s", "--denoise", "joint", "--denoise-model", none}),
              ExitCode::failed);
    EXPECT_EQ(read_whole_file(stored), "");
    // Too short to learn from: the capture is there, and said is why the other is not.
    EXPECT_EQ(capture("sim:rate=200", {"--duration", "4s", "--denoise", "joint"}), ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("ended before the board had rested for 10 s"));
    EXPECT_EQ(read_whole_file(live), "");
    EXPECT_NE(read_whole_file(stored), "");
    // The board's rate is known only once it is there.
    EXPECT_EQ(capture("sim:rate=200", {"--duration", "4s", "--denoise", "joint", "--bandwidth", "95"}),
              ExitCode::failed);
    EXPECT_THAT(err.str(), HasSubstr("nothing is denoised: --bandwidth 95 Hz"));
}

TEST_F(LiveDenoising, AnEarlierTextStaysWhereNothingIsDenoised) {
    std::ofstream(live) << "last night's\n";
    for (const char* device : {"sim:rate=200", "sim:rate=200,fault=int_lost@0"}) {
        EXPECT_NE(capture(device, {"--duration", "4s", "--denoise", "joint"}), ExitCode::ok) << device;
        EXPECT_EQ(read_whole_file(live), "last night's\n") << device;
    }
    EXPECT_EQ(capture("sim:rate=200", {"--duration", "12s", "--denoise", "joint"}), ExitCode::ok)
        << err.str();
    EXPECT_EQ(read(live).rows(), 2400U);
}

TEST_F(LiveDenoising, ATextThatCannotBeWrittenCostsTheCaptureNothing) {
    EXPECT_EQ(
        capture("sim:rate=200", {"--duration", "60s", "--denoise", "wavelet", "--denoise-out", "/dev/full"}),
        ExitCode::disk_full);
    EXPECT_THAT(err.str(), HasSubstr("write '/dev/full'"));
    out.str("");
    EXPECT_EQ(run_command_line({"check", stored, "--json", "-"}, {out, err}), ExitCode::ok);
    EXPECT_EQ(json::parse(out.str())["samples"]["good"], 12'000);
}

TEST_F(LiveDenoising, SamplesThatFindNoRoomAreAHoleAndCounted) {
    LiveDenoise::Setup setup;
    setup.options.choice.method = "kalman";
    setup.options.model = folder.path("known.json");
    setup.output = live;
    setup.rows_waiting_most = 150;
    ASSERT_TRUE(write_model(typical_mpu9250(), setup.options.model).ok());
    auto denoise = LiveDenoise::create(setup);
    ASSERT_TRUE(denoise.ok()) << denoise.error().message;
    const StreamDecoder decoder;
    (*denoise)->on_decoder(decoder);
    glp_config config{};
    config.rate_mHz = 100'000;
    config.gyro_ndps_per_lsb = 15'258'789;
    const std::vector<std::uint8_t> zeros(6 * 200);
    glp_samples samples{};
    samples.layout = glp_layout_gyro;
    samples.samples = zeros.data();
    for (const std::uint8_t count : {std::uint8_t{100}, std::uint8_t{200}}) {
        samples.count = count;
        (*denoise)->on_samples({}, samples, config);
        samples.first_index += count;
    }
    const auto done = (*denoise)->finish();
    ASSERT_FALSE(done.ok());
    EXPECT_THAT(done.error().message, HasSubstr("200 samples found no room"));
    EXPECT_EQ(read(live).rows(), 100U);
}

TEST_F(LiveDenoising, TextThatGrowsIsThereBeforeItsEnd) {
    {
        CsvWriteOptions options;
        options.growth = TextGrowth::growing;
        auto writer = RecordingCsvWriter::create(live, options);
        ASSERT_TRUE(writer.ok());
        ASSERT_TRUE(writer->append(array_of(1)).ok());
        ASSERT_TRUE(writer->flush().ok());
        EXPECT_EQ(read(live).rows(), rows);
    }
    EXPECT_EQ(read(live).rows(), rows);  // without close()
}

}  // namespace
}  // namespace gyrolog
