// Captures with right checksums whose counters contradict their samples: every command says so, and none
// invents or loses a sample.
#include <fstream>
#include <functional>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/app/command_line.hpp"
#include "host/session/load_capture.hpp"
#include "tests/host/capture/made_capture.hpp"
#include "tests/host/decode/made_stream.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

struct Answer {
    ExitCode exit_code = ExitCode::ok;
    std::string out;
    std::string err;
};

Answer run(std::vector<std::string> arguments) {
    std::ostringstream out;
    std::ostringstream err;
    const ExitCode code = run_command_line(std::move(arguments), {out, err});
    return {code, out.str(), err.str()};
}

std::size_t lines_of(const std::string& path) {
    const std::string text = read_whole_file(path);
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

// A board's stream, and the file that a program makes of it, whose counters are those of the stream unless
// they are changed.
class ContradictedCapture : public testing::Test {
protected:
    ContradictedCapture() {
        auto writer = CaptureWriter::create(disk.open(), made_identity(), made_start);
        EXPECT_TRUE(writer.ok());
        file = std::make_unique<CaptureWriter>(*std::move(writer));
        hear(board.hello_frame());
        hear(board.config_frame());
        hear(board.event_frame(glp_event_started));
        hear(board.samples_frame(glp_flag_first_after_start));
        hear_samples(99);
    }

    void hear(const Bytes& wire) {
        Transfer transfer;
        transfer.endpoint = 0x81;
        transfer.id = ++transfers;
        transfer.data = wire;
        transfer.time = {made_start.monotonic_ns + board.now().monotonic_ns, 0};
        EXPECT_TRUE(file->append(transfer).ok());
        static_cast<void>(decoder.take(transfer));
    }
    void hear_samples(std::size_t frames) {
        for (std::size_t i = 0; i < frames; ++i) { hear(board.samples_frame()); }
    }
    CaptureCounters counters() const {
        const LinkCounts link = decoder.counts();
        return {.stream_bytes = link.bytes.total,
                .frames = link.frames.good,
                .samples = link.samples.good,
                .frames_missing = link.frames.missing,
                .samples_missing = link.samples.missing};
    }
    void close(const CaptureCounters& told) {
        EXPECT_TRUE(file->checkpoint(told, made_start).ok());
        EXPECT_TRUE(file->close().ok());
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(disk.contents.data()),
                   static_cast<std::streamsize>(disk.contents.size()));
    }
    void close() { close(counters()); }

    // `samples` rows are exported, and none of them is made up.
    void expect_told(const std::string& what, std::size_t samples) {
        const Answer check = run({"check", path});
        EXPECT_EQ(check.exit_code, ExitCode::data_lost) << check.out;
        EXPECT_THAT(unwrapped(check.out), HasSubstr(what));
        EXPECT_THAT(unwrapped(check.out), HasSubstr("the counters contradict the samples: how much is "
                                                    "missing is not certain"));
        const json as_json = json::parse(run({"check", path, "--json", "-"}).out);
        EXPECT_EQ(as_json["samples"]["good"], samples);
        ASSERT_EQ(as_json["contradictions"].size(), 1U);
        EXPECT_THAT(as_json["contradictions"][0].get<std::string>(), HasSubstr(what));
        EXPECT_THAT(unwrapped(run({"info", path}).out), HasSubstr(what));
        const std::string text = folder.path("e.csv");
        const Answer exported = run({"export", path, "-o", text});
        EXPECT_EQ(exported.exit_code, ExitCode::ok) << exported.err;
        EXPECT_THAT(unwrapped(exported.err), HasSubstr(what));
        EXPECT_EQ(lines_of(text), samples + 1);
    }
    static std::string unwrapped(const std::string& text) {
        std::istringstream words(text);
        std::string all;
        for (std::string word; words >> word;) { all += word + ' '; }
        return all;
    }

    TemporaryFolder folder;
    std::string path = folder.path("made.pcapng");
    FakeDisk disk;
    std::unique_ptr<CaptureWriter> file;
    MadeBoard board;
    StreamDecoder decoder;
    std::uint64_t transfers = 0;
};

TEST_F(ContradictedCapture, OfAnHonestBoardThereIsNone) {
    board.lose_samples(40);
    hear_samples(100);
    hear(board.status_frame());
    board.restart(board.time_s() + 2.0);
    hear(board.hello_frame());
    hear(board.config_frame());
    hear(board.event_frame(glp_event_started));
    hear(board.samples_frame(glp_flag_first_after_start));
    hear_samples(100);
    hear(board.status_frame());
    hear(board.event_frame(glp_event_stopped));
    close();
    const Answer check = run({"check", path});
    EXPECT_THAT(check.out, Not(HasSubstr("contradict")));
    EXPECT_THAT(check.out, HasSubstr("dropout at 1.595 s: 40 samples, device"));
    EXPECT_EQ(check.exit_code, ExitCode::data_lost);
    EXPECT_TRUE(json::parse(run({"check", path, "--json", "-"}).out)["contradictions"].empty());
}

TEST_F(ContradictedCapture, SamplesCountedAsLostThatAreThere) {
    board.lost_samples += 50;
    hear_samples(100);
    close();
    expect_told("the board counts 50 samples as lost, and no gap in its indices has room for that", 3200);
}

TEST_F(ContradictedCapture, AStatusThatCountsMoreLostThanPassed) {
    board.lost_samples += 50;
    hear(board.status_frame());
    board.lost_samples -= 50;
    hear_samples(100);
    close();
    expect_told("the board counts 50 samples as lost, and no gap in its indices has room for that", 3200);
}

TEST_F(ContradictedCapture, FramesCountedAsDroppedThatAreThere) {
    hear(board.status_frame());
    board.lost_frames += 7;
    hear(board.status_frame());
    hear_samples(100);
    close();
    expect_told("the board counts 7 frames as dropped, and no gap in their numbers has room for that", 3200);
}

TEST_F(ContradictedCapture, AnIndexThatComesAgain) {
    board.index -= 160;
    board.start_s += 160.0 / board.rate_hz;  // its clock goes on
    hear_samples(100);
    close();
    expect_told("samples have an index that earlier ones had, and the board was not started anew (1 time)",
                3200);
}

TEST_F(ContradictedCapture, AnIndexThatNoSensorReaches) {
    board.index += 100'000'000;
    board.start_s -= 1e8 / board.rate_hz;
    hear_samples(100);
    close();
    expect_told("samples have an index that no sensor reaches in the time since those before (1 time)", 3200);
    const json check = json::parse(run({"check", path, "--json", "-"}).out);
    EXPECT_EQ(check["samples"]["missing"], 0);
    EXPECT_NEAR(check["duration_s"].get<double>(), 3.19, 0.01);
    const std::string analysis = run({"analyze", path, "--sensor", "gyro"}).out;
    EXPECT_THAT(analysis, HasSubstr("made.pcapng: 3,200 samples, 3.19 s"));
    EXPECT_THAT(analysis, HasSubstr("\nno dropouts\nwarning: samples have an index that no sensor reaches"));
}

TEST_F(ContradictedCapture, AStatusThatCountsLessThanCame) {
    board.index -= 160;
    const Bytes status = board.status_frame();
    board.index += 160;
    hear(status);
    hear_samples(100);
    close();
    expect_told("the board counts fewer samples than it had sent (1 time)", 3200);
}

TEST_F(ContradictedCapture, AStatusThatCountsWhatNoSensorMakes) {
    hear_samples(100);
    board.index += 100'000'000;
    board.start_s -= 1e8 / board.rate_hz;
    hear(board.status_frame());
    close();
    expect_told("the board counts more samples than any sensor makes in the time since its last (1 time)",
                3200);
    EXPECT_EQ(json::parse(run({"check", path, "--json", "-"}).out)["samples"]["missing"], 0);
}

TEST_F(ContradictedCapture, CountersOfTheFileThatAreNotThoseOfTheStream) {
    CaptureCounters told = counters();
    told.samples += 1000;
    close(told);
    expect_told("the writer counted 2,600 samples up to a checkpoint, and 1,600 are there", 1600);
}

TEST_F(ContradictedCapture, FramesOfTheFileThatAreNotThoseOfTheStream) {
    CaptureCounters told = counters();
    told.frames -= 3;
    close(told);
    expect_told("the writer counted 100 frames up to a checkpoint, and 103 are there", 1600);
}

}  // namespace
}  // namespace gyrolog
