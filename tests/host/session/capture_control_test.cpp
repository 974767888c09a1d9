// What a user does to a running capture: marks, stop, start.
#include "host/session/capture_control.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "host/session/capture_session.hpp"
#include "host/session/load_capture.hpp"
#include "tests/host/session/board_source.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

class ControlledCapture : public testing::Test {
protected:
    ControlledCapture() {
        request_.path = folder_.path("run.pcapng");
        request_.control = &control_;
    }

    LoadedCapture loaded() const {
        auto capture = load_capture(request_.path, false);
        EXPECT_TRUE(capture.ok());
        return capture.ok() ? std::move(capture).value() : LoadedCapture{};
    }

    TemporaryFolder folder_;
    CaptureControl control_;
    CaptureRequest request_;
};

TEST_F(ControlledCapture, MarksStandInTheFileInTheOrderTheyWereMade) {
    // Board time as host time: then the two clocks can be compared.
    const auto source = BoardSource::create({.turn_board_s = 0.010, .turn_host_s = 0.010});
    request_.duration_s = 0.9;
    int turns = 0;
    std::uint64_t marks_told = 0;
    const auto outcome = run_capture(*source, request_, [&](const CaptureProgress& progress) {
        ++turns;
        if (turns == 3) { control_.mark("lamp on"); }
        if (turns == 6) { control_.mark(""); }
        marks_told = progress.marks;
        return true;
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(marks_told, 2U);
    const LoadedCapture capture = loaded();
    ASSERT_EQ(capture.marks.size(), 2U);
    EXPECT_EQ(capture.marks[0].text, "lamp on");
    EXPECT_EQ(capture.marks[1].text, "");
    EXPECT_GT(capture.marks[0].stream_bytes, 0U);
    EXPECT_LT(capture.marks[0].stream_bytes, capture.marks[1].stream_bytes);
    EXPECT_LT(capture.marks[1].stream_bytes, capture.decoder->report().bytes.total);

    const auto fit = capture.decoder->timeline().host_clock();
    ASSERT_TRUE(fit.has_value());
    const auto device_s = [&](const CaptureMark& mark) {
        return (static_cast<double>(mark.time.monotonic_ns) * 1e-9 - fit->offset_s) / fit->ratio;
    };
    EXPECT_GT(device_s(capture.marks[0]), 0.1);
    EXPECT_LT(device_s(capture.marks[1]), 0.9);
    EXPECT_GT(device_s(capture.marks[1]), device_s(capture.marks[0]) + 0.1);
}

TEST_F(ControlledCapture, MarkMadeAtTheVeryEndIsKept) {
    const auto source = BoardSource::create({});
    const auto outcome = run_capture(*source, request_, [&](const CaptureProgress& progress) {
        if (progress.samples < 500) { return true; }
        control_.mark("the end");
        return false;
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    ASSERT_EQ(loaded().marks.size(), 1U);
}

TEST_F(ControlledCapture, StoppedAndStartedAgainIsAnotherRunAndNothingIsMissing) {
    for (const bool has_line : {true, false}) {
        const auto source =
            BoardSource::create({.has_line = has_line, .turn_board_s = 0.010, .turn_host_s = 0.002});
        request_.overwrite = true;
        request_.idle_timeout_s = 0.3;  // a stop by the user's wish is longer, and no lost board
        control_.set_streaming(true);
        int turns_stopped = 0;
        std::uint64_t samples_when_stopped = 0;
        const auto outcome = run_capture(*source, request_, [&](const CaptureProgress& progress) {
            if (turns_stopped == 0 && progress.samples >= 500) { control_.set_streaming(false); }
            if (!progress.streaming) {
                if (++turns_stopped == 5) { control_.set_streaming(true); }
                if (turns_stopped > 2) { samples_when_stopped = progress.samples; }
            }
            return progress.samples < samples_when_stopped + 700 || samples_when_stopped == 0;
        });
        ASSERT_TRUE(outcome.ok()) << outcome.error().message;
        EXPECT_EQ(outcome->end, CaptureEnd::interrupted);
        EXPECT_GE(turns_stopped, 5);
        EXPECT_EQ(outcome->link.runs, 2U);
        EXPECT_FALSE(outcome->data_lost());
        const LoadedCapture capture = loaded();
        EXPECT_EQ(capture.decoder->report().samples.good, outcome->link.samples.good);
        EXPECT_GE(outcome->link.samples.good, samples_when_stopped + 700);
        EXPECT_FALSE(source->board().streaming());
    }
}

// A caller that throws ends the capture: what came is in the file, and nobody waits for a writer that waits.
TEST_F(ControlledCapture, ThrowingObserverEndsIt) {
    const auto source = BoardSource::create({.turn_board_s = 0.010, .turn_host_s = 0.002});
    EXPECT_THROW(static_cast<void>(run_capture(*source, request_,
                                               [](const CaptureProgress& progress) -> bool {
                                                   if (progress.samples < 500) { return true; }
                                                   throw std::runtime_error("the view");
                                               })),
                 std::runtime_error);
    EXPECT_GE(loaded().decoder->report().samples.good, 500U);
}

// The samples as they come. A board that was running may still finish a frame from before the start, whose
// configuration nobody has told.
TEST_F(ControlledCapture, ObserverSeesEverySampleOfTheCapture) {
    class Counter final : public SampleObserver {
    public:
        void on_start() override { samples = 0; }
        void on_samples(const glp_frame& /*frame*/, const glp_samples& frame_samples,
                        const glp_config& config) override {
            samples += frame_samples.count;
            rate_mHz = config.rate_mHz;
        }
        std::uint64_t samples = 0;
        std::uint32_t rate_mHz = 0;
    };
    Counter counter;
    request_.observer = &counter;
    request_.duration_s = 1.0;
    for (const bool was_running : {false, true}) {
        const auto source = BoardSource::create({.streams_before_start = was_running});
        request_.overwrite = true;
        const auto outcome =
            run_capture(*source, request_, [](const CaptureProgress& /*progress*/) { return true; });
        ASSERT_TRUE(outcome.ok()) << outcome.error().message;
        EXPECT_LE(counter.samples, outcome->link.samples.good);
        EXPECT_GE(counter.samples, outcome->link.samples.good - (was_running ? 100 : 0));
        EXPECT_EQ(counter.rate_mHz, 1'000'000U);
    }
}

}  // namespace
}  // namespace gyrolog
