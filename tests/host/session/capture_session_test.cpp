#include "host/session/capture_session.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <gyrolog_protocol/cobs.h>
#include <gyrolog_protocol/crc.h>

#include "host/capture/capture_reader.hpp"
#include "host/session/load_capture.hpp"
#include "host/transport/replay_source.hpp"
#include "host/virtual_board/breached_source.hpp"
#include "tests/host/session/board_source.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

bool go_on(const CaptureProgress& /*progress*/) { return true; }

// A frame that is right in everything but its major version.
Bytes frame_of_major_version(std::uint8_t major) {
    Bytes body{major, glp_frame_hello, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4};
    const std::uint32_t crc = glp_crc32(body.data(), body.size());
    for (unsigned shift = 0; shift < 32; shift += 8) {
        body.push_back(static_cast<std::uint8_t>(crc >> shift));
    }
    Bytes wire(body.size() + 3, 0);
    const glp_cobs_result encoded =
        glp_cobs_encode(body.data(), body.size(), wire.data() + 1, wire.size() - 2);
    EXPECT_EQ(encoded.status, glp_status_ok);
    wire.resize(encoded.size + 2);
    return wire;
}

// The board of `manner`, with what it says tampered with on the way.
std::unique_ptr<ByteSource> tampered(const SourceManner& manner, const Breach& breach) {
    return std::make_unique<BreachedSource>(BoardSource::create(manner), breach);
}

class CaptureSession : public testing::Test {
protected:
    CaptureSession() {
        request_.path = folder_.path("run.pcapng");
        request_.hello_timeout_s = 5.0;
        request_.duration_s = 1.0;
    }

    Result<CaptureOutcome> capture(ByteSource& source, const CaptureObserver& observe = go_on) const {
        return run_capture(source, request_, observe);
    }
    bool file_is_there() const { return std::filesystem::exists(request_.path); }

    // The stream as the file has it. The file must be whole.
    static Bytes stored_stream(const std::string& path) {
        Bytes stream;
        auto reader = CaptureReader::open(path);
        EXPECT_TRUE(reader.ok());
        while (reader.ok()) {
            const auto captured = reader->next();
            EXPECT_TRUE(captured.ok());
            if (!captured.ok() || !*captured) { break; }
            const Transfer& transfer = (*captured)->transfer;
            if (!transfer.carries_stream()) { continue; }
            stream.insert(stream.end(), transfer.data.begin(), transfer.data.end());
        }
        EXPECT_EQ(reader->accounts().blocks.end, FileEnd::clean);
        return stream;
    }
    LoadedCapture loaded() const {
        auto capture = load_capture(request_.path, false);
        EXPECT_TRUE(capture.ok());
        return capture.ok() ? std::move(capture).value() : LoadedCapture{};
    }

    TemporaryFolder folder_;
    CaptureRequest request_;
};

// ------------------------------------------------------------------------------------- lines of every kind

TEST_F(CaptureSession, StoresByteForByteWhatTheSourceDelivered) {
    const auto source = BoardSource::create({});
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_FALSE(outcome->data_lost());
    EXPECT_GT(source->delivered().size(), 10'000U);
    EXPECT_EQ(stored_stream(request_.path), source->delivered());
    EXPECT_EQ(outcome->link.bytes.total, source->delivered().size());
    EXPECT_EQ(source->writes(), 0) << "a line with DTR needs no commands";
    EXPECT_FALSE(source->line_raised()) << "the board is left quiet";
}

TEST_F(CaptureSession, TellsWhoTheBoardIsAndHowItIsSetUp) {
    const auto source = BoardSource::create({});
    request_.configure.rate_mHz = 500'000;
    request_.configure.gyro_full_scale_dps = 1000;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    ASSERT_TRUE(outcome->progress.hello && outcome->progress.config);
    EXPECT_EQ(outcome->progress.hello->who_am_i, 0x71);
    EXPECT_EQ(outcome->progress.config->rate_mHz, 500'000U);
    EXPECT_EQ(outcome->progress.config->gyro_full_scale_dps, 1000U);
    EXPECT_NEAR(outcome->progress.rate_hz.value(), 500.0, 500.0 * 0.03);
    EXPECT_TRUE(outcome->progress.temperature_C.has_value());
    EXPECT_GT(outcome->progress.file_bytes, outcome->link.bytes.total);
}

TEST_F(CaptureSession, LineWithoutControlSignalsIsRunByCommands) {
    const auto source = BoardSource::create({.has_line = false});
    request_.configure.rate_mHz = 500'000;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_FALSE(outcome->data_lost());
    EXPECT_EQ(outcome->progress.config->rate_mHz, 500'000U);
    EXPECT_EQ(source->writes(), 5) << "STOP, CONFIGURE, START, GET_HELLO, and STOP at the end";
    EXPECT_FALSE(source->board().streaming());
    EXPECT_EQ(outcome->link.samples.good, source->board().sampling_instants());
    EXPECT_EQ(stored_stream(request_.path), source->delivered());
}

TEST_F(CaptureSession, ReplayedCaptureIsStoredAgainByteForByte) {
    const auto source = BoardSource::create({});
    ASSERT_TRUE(capture(*source).ok());
    const auto replay = ReplaySource::open(request_.path);
    ASSERT_TRUE(replay.ok());
    CaptureRequest again;
    again.path = folder_.path("again.pcapng");
    const auto outcome = run_capture(**replay, again, go_on);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_EQ(stored_stream(again.path), source->delivered());
}

TEST_F(CaptureSession, ReplayedCaptureCannotBeConfigured) {
    ASSERT_TRUE(capture(*BoardSource::create({})).ok());
    const auto replay = ReplaySource::open(request_.path);
    ASSERT_TRUE(replay.ok());
    CaptureRequest again;
    again.path = folder_.path("again.pcapng");
    again.configure.rate_mHz = 100'000;
    const auto outcome = run_capture(**replay, again, go_on);
    ASSERT_FALSE(outcome.ok());
    EXPECT_EQ(outcome.error().code, ErrorCode::invalid_argument);
}

// ------------------------------------------------------------------------- boards that cannot be captured

TEST_F(CaptureSession, SilentBoardIsAnErrorAndLeavesNoFile) {
    const auto source = BoardSource::create({.speaks_instead = Bytes{}});
    request_.hello_timeout_s = 0.2;
    const auto outcome = capture(*source);
    ASSERT_FALSE(outcome.ok());
    EXPECT_EQ(outcome.error().code, ErrorCode::timeout);
    EXPECT_NE(outcome.error().message.find("test:board"), std::string::npos) << outcome.error().message;
    EXPECT_NE(outcome.error().message.find("no gyrolog board"), std::string::npos);
    EXPECT_FALSE(file_is_there());
    EXPECT_FALSE(source->line_raised()) << "what was started is stopped again";
    EXPECT_TRUE(source->was_let_go()) << "before the source is gone";
}

// SPEC.md, 9.6: a REPLY may be lost, and is waited for 1 s.
TEST_F(CaptureSession, UnansweredCommandIsGivenUpAfterASecond) {
    const Breach deaf{"", "", "", nullptr, [](BreachedLine&, ByteView) { return Bytes{}; }, nullptr};
    const auto source = tampered({}, deaf);
    request_.configure.rate_mHz = 500'000;
    const auto before = std::chrono::steady_clock::now();
    const auto outcome = capture(*source);
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - before;
    ASSERT_FALSE(outcome.ok());
    EXPECT_EQ(outcome.error().code, ErrorCode::timeout) << outcome.error().message;
    EXPECT_GT(waited.count(), 0.9);
    EXPECT_LT(waited.count(), 2.0);
}

// SPEC.md, 9.7.
TEST_F(CaptureSession, RepliesStandInTheCaptureInTheirPlace) {
    const auto source = BoardSource::create({});
    request_.configure.rate_mHz = 500'000;
    ASSERT_TRUE(capture(*source).ok());
    class Order final : public MessageHandler {
    public:
        std::vector<std::pair<std::uint32_t, std::uint8_t>> frames;

    private:
        void on_hello(const ReceivedFrame& f, const glp_hello&) override { note(f); }
        void on_config(const ReceivedFrame& f, const glp_config&) override { note(f); }
        void on_samples(const ReceivedFrame& f, const glp_samples&) override { note(f); }
        void on_status(const ReceivedFrame& f, const glp_device_status&) override { note(f); }
        void on_event(const ReceivedFrame& f, const glp_event&) override { note(f); }
        void on_reply(const ReceivedFrame& f, const glp_reply&) override { note(f); }
        void note(const ReceivedFrame& f) { frames.emplace_back(f.frame.sequence, f.frame.type); }
    } order;
    FrameDecoder decoder;
    decoder.feed(stored_stream(request_.path), HostTime{}, order);
    ASSERT_GT(order.frames.size(), 10U);
    for (std::size_t i = 1; i < order.frames.size(); ++i) {
        EXPECT_EQ(order.frames[i].first, order.frames[i - 1].first + 1);
    }
    ASSERT_GE(order.frames.size(), 3U);
    EXPECT_EQ(order.frames[0].second, glp_frame_reply) << "to the CONFIGURE before the start";
    EXPECT_EQ(order.frames[1].second, glp_frame_config);
    EXPECT_EQ(order.frames[2].second, glp_frame_hello);
}

// By line and by commands, each of which waits for an answer.
TEST_F(CaptureSession, ABoardThatDoesNotAnswerIsWaitedForOnlyAsLongAsTheCallerWants) {
    for (const bool has_line : {true, false}) {
        const auto source = BoardSource::create({.has_line = has_line, .speaks_instead = Bytes{}});
        request_.hello_timeout_s = 60.0;
        request_.configure.rate_mHz = has_line ? 0 : 1'000'000;
        unsigned asked = 0;
        const auto begin = std::chrono::steady_clock::now();
        const auto outcome = run_capture(*source, request_, [&](const CaptureProgress& progress) {
            EXPECT_FALSE(progress.hello.has_value());
            return ++asked < 3;
        });
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(900));
        ASSERT_FALSE(outcome.ok());
        EXPECT_EQ(outcome.error().code, ErrorCode::failed);
        EXPECT_NE(outcome.error().message.find("ended before"), std::string::npos) << outcome.error().message;
        EXPECT_EQ(asked, 3U);
        EXPECT_FALSE(file_is_there());
    }
}

TEST_F(CaptureSession, StrangersBytesAreAnErrorAndAreKept) {
    const Bytes strange(700, 0x24);
    const auto source = BoardSource::create({.speaks_instead = strange});
    request_.hello_timeout_s = 0.2;
    const auto outcome = capture(*source);
    ASSERT_FALSE(outcome.ok());
    EXPECT_EQ(outcome.error().code, ErrorCode::malformed);
    EXPECT_NE(outcome.error().message.find("test:board: 700 bytes"), std::string::npos)
        << outcome.error().message;
    EXPECT_NE(outcome.error().message.find("no gyrolog board"), std::string::npos);
    EXPECT_TRUE(source->was_let_go());
    EXPECT_EQ(stored_stream(request_.path), strange);
    EXPECT_FALSE(source->line_raised()) << "what was started is stopped again";
}

TEST_F(CaptureSession, AnotherMajorVersionIsNamedAsSuch) {
    const auto source =
        BoardSource::create({.speaks_instead = frame_of_major_version(GLP_PROTOCOL_MAJOR + 1)});
    request_.hello_timeout_s = 0.2;
    const auto outcome = capture(*source);
    ASSERT_FALSE(outcome.ok());
    EXPECT_EQ(outcome.error().code, ErrorCode::unsupported);
    EXPECT_NE(outcome.error().message.find("another major version"), std::string::npos)
        << outcome.error().message;
}

TEST_F(CaptureSession, ConfigurationThatTheSensorDoesNotHaveIsTheCallersMistake) {
    for (const bool has_line : {true, false}) {
        const auto source = BoardSource::create({.has_line = has_line});
        request_.configure.gyro_full_scale_dps = 333;
        request_.overwrite = true;
        const auto outcome = capture(*source);
        ASSERT_FALSE(outcome.ok());
        EXPECT_EQ(outcome.error().code, ErrorCode::invalid_argument) << outcome.error().message;
        EXPECT_NE(outcome.error().message.find("test:board"), std::string::npos);
        EXPECT_FALSE(source->board().streaming());
    }
}

TEST_F(CaptureSession, BoardUnpluggedDuringTheHandshakeIsCalledLost) {
    const auto source = BoardSource::create({.lost_when_written_to = true});
    request_.configure.rate_mHz = 500'000;
    const auto outcome = capture(*source);
    ASSERT_FALSE(outcome.ok());
    EXPECT_EQ(outcome.error().code, ErrorCode::device_lost) << outcome.error().message;
    EXPECT_FALSE(file_is_there());
}

TEST_F(CaptureSession, ExistingFileIsNotTouchedUnlessToldSo) {
    std::ofstream(request_.path) << "precious";
    const auto source = BoardSource::create({});
    const auto outcome = capture(*source);
    ASSERT_FALSE(outcome.ok());
    EXPECT_EQ(outcome.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(std::filesystem::file_size(request_.path), 8U);
    request_.overwrite = true;
    EXPECT_TRUE(capture(*source).ok());
}

// ------------------------------------------------------------------------------------------- how it ends

TEST_F(CaptureSession, DurationIsOfDeviceTime) {
    const auto source = BoardSource::create({});
    request_.duration_s = 2.0;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_GE(outcome->progress.device_s, 2.0);
    EXPECT_LT(outcome->progress.elapsed_s, 2.0) << "the board's clock was made to run twenty times faster";
}

TEST_F(CaptureSession, StopsOnceThereAreEnoughSamples) {
    const auto source = BoardSource::create({});
    request_.duration_s.reset();
    request_.samples = 1500;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_GE(outcome->link.samples.good, 1500U);
    EXPECT_EQ(outcome->link.samples.missing, 0U);
}

// The index of a sample counts from the board's start, not from the capture's.
TEST_F(CaptureSession, BoardThatWasAlreadyStreamingIsCapturedAtFullLength) {
    for (const bool has_line : {true, false}) {
        const auto source = BoardSource::create({.has_line = has_line, .streams_before_start = true});
        request_.duration_s.reset();
        request_.samples = 1500;
        request_.overwrite = true;
        const auto outcome = capture(*source);
        ASSERT_TRUE(outcome.ok()) << outcome.error().message;
        EXPECT_EQ(outcome->end, CaptureEnd::complete);
        EXPECT_GE(outcome->link.samples.good, 1500U);
    }
}

TEST_F(CaptureSession, RestartedStreamDoesNotBeginTheCaptureAnew) {
    const auto source = BoardSource::create({.restarted_at_s = 1.0});
    request_.duration_s.reset();
    request_.samples = 1500;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->link.runs, 2U);
    EXPECT_GE(outcome->link.samples.good, 1500U);
    EXPECT_LT(source->board().sampling_instants(), 1500U) << "a second of it came before the restart";
}

TEST_F(CaptureSession, InterruptedCaptureHasTheBoardsPartialFrame) {
    const auto source = BoardSource::create({.frozen_from_s = 1.003});
    request_.duration_s.reset();
    const auto outcome =
        capture(*source, [](const CaptureProgress& progress) { return progress.samples < 900; });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::interrupted);
    EXPECT_NE(outcome->link.samples.good % outcome->progress.config->samples_per_frame, 0U)
        << "the stop found no frame half full: this test tests nothing";
    EXPECT_EQ(outcome->link.samples.good, source->board().sampling_instants());
    EXPECT_FALSE(outcome->data_lost());
    EXPECT_EQ(stored_stream(request_.path), source->delivered());
}

TEST_F(CaptureSession, LostDeviceLeavesAReadableFileWithAllThatCame) {
    VirtualBoardOptions options;
    options.faults = {{BoardFault::Kind::unplug, 1.0, 0.0}};
    const auto source = BoardSource::create({}, std::move(options));
    request_.duration_s = 60.0;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::device_lost);
    ASSERT_TRUE(outcome->error.has_value());
    EXPECT_EQ(outcome->error->message, "test:board: unplugged");
    EXPECT_GT(outcome->link.samples.good, 900U);
    EXPECT_EQ(stored_stream(request_.path), source->delivered());
    EXPECT_EQ(loaded().decoder->report().samples.good, outcome->link.samples.good);
}

TEST_F(CaptureSession, SilenceCountsAsALostDevice) {
    const auto source = BoardSource::create({.frozen_from_s = 0.5});
    request_.idle_timeout_s = 0.3;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::device_lost);
    ASSERT_TRUE(outcome->error.has_value());
    EXPECT_EQ(outcome->error->code, ErrorCode::device_lost);
    EXPECT_EQ(outcome->error->message, "test:board: silent for 0.3 s");
    EXPECT_EQ(stored_stream(request_.path), source->delivered());
}

TEST_F(CaptureSession, ADurationEndsByTheClockWhereTheLinkIsSilent) {
    const auto source = BoardSource::create({.frozen_from_s = 0.5});
    request_.silence_s = 0.3;
    request_.duration_s = 1.0;
    const std::int64_t start_ns = host_now().monotonic_ns;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::device_lost);
    EXPECT_LT(host_now().monotonic_ns - start_ns, 5'000'000'000)
        << "not by the silence of a lost board, 10 s";
    EXPECT_EQ(outcome->paths.size(), 1U);
    EXPECT_EQ(stored_stream(request_.path), source->delivered());
}

TEST_F(CaptureSession, FullDiskEndsTheCaptureAndLeavesAReadableFile) {
    const auto source = BoardSource::create({});
    request_.duration_s = 600.0;
    const auto outcome = [&] {
        const FileSizeLimit full_disk(100'000);
        return capture(*source);
    }();
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::storage_failed);
    ASSERT_TRUE(outcome->error.has_value());
    EXPECT_EQ(outcome->error->code, ErrorCode::disk_full);
    EXPECT_LT(outcome->progress.device_s, 60.0) << "it ends at once, not when all was asked for";
    EXPECT_LE(std::filesystem::file_size(request_.path), 100'000U);
    const Bytes stored = stored_stream(request_.path);
    EXPECT_GT(stored.size(), 20'000U);
    ASSERT_LT(stored.size(), source->delivered().size());
    EXPECT_TRUE(std::equal(stored.begin(), stored.end(), source->delivered().begin()));
}

// ------------------------------------------------------------------------------------------ a full queue

TEST_F(CaptureSession, FullQueueIsCountedToTheByteAndSeenAsMissingSamples) {
    // Bursts of 10 kB meet a queue of 2 kB, with pauses in which it drains.
    const auto source = BoardSource::create({.turn_board_s = 0.5, .turn_host_s = 0.03});
    request_.queue_bytes = 2048;
    request_.duration_s = 3.0;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_GT(outcome->bytes_dropped, 0U);
    EXPECT_EQ(outcome->bytes_dropped, source->bytes_refused());
    EXPECT_EQ(outcome->transfers_dropped, source->transfers_refused());
    EXPECT_TRUE(outcome->data_lost());
    EXPECT_LE(outcome->queue_high_water_bytes, 2048U);
    EXPECT_GT(outcome->link.samples.missing, 0U);
    EXPECT_EQ(outcome->link.samples.good + outcome->link.samples.missing,
              source->board().sampling_instants());
    EXPECT_EQ(stored_stream(request_.path), source->delivered());
    const LoadedCapture stored = loaded();
    EXPECT_EQ(stored.decoder->report().samples.missing, outcome->link.samples.missing);
    ASSERT_TRUE(stored.last_checkpoint.has_value());
    EXPECT_EQ(stored.last_checkpoint->counters.bytes_dropped, outcome->bytes_dropped);
    EXPECT_EQ(stored.last_checkpoint->counters.transfers_dropped, outcome->transfers_dropped);
}

TEST_F(CaptureSession, FullQueueHoldsUpASourceThatCanWait) {
    const auto source = BoardSource::create({.can_wait = true, .turn_board_s = 0.5});
    request_.queue_bytes = 2048;
    request_.duration_s = 3.0;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->transfers_dropped, 0U);
    EXPECT_FALSE(outcome->data_lost());
    EXPECT_TRUE(outcome->link.complete());
    EXPECT_GE(outcome->link.samples.good, 3000U);
    // What comes behind the end that was asked for is left.
    const Bytes stored = stored_stream(request_.path);
    ASSERT_LE(stored.size(), source->delivered().size());
    EXPECT_TRUE(std::ranges::equal(stored, ByteView(source->delivered()).first(stored.size())));
}

// ------------------------------------------------------------------------------------------ hostile devices

constexpr Breach frames_by(void (*hook)(BreachedLine&, RawFrame&)) {
    return {"", "", "", hook, nullptr, nullptr};
}

// The first HELLO says 1 MHz; all the time others follow, which say 2 MHz.
void changes_its_mind(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_hello) { line.kept = frame; }
    line.send(frame);
    if (frame.type != glp_frame_samples || !line.kept) { return; }
    RawFrame other = *line.kept;
    other.payload[4] = 0x80;  // 2'000'000 = 1e8480
    other.payload[5] = 0x84;
    other.payload[6] = 0x1E;
    line.send(other);
}

TEST_F(CaptureSession, TheFirstWordOfABoardThatContradictsItselfHolds) {
    const Breach breach = frames_by(changes_its_mind);
    const auto source = tampered({}, breach);
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_GT(outcome->link.hellos_contradicting, 10U);
    EXPECT_EQ(outcome->link.frames.corrupted, outcome->link.hellos_contradicting);
    EXPECT_EQ(outcome->link.samples.missing, 0U);
    EXPECT_EQ(outcome->progress.hello->tick_hz, 1'000'000U);
    EXPECT_NEAR(*outcome->progress.rate_hz, 1000.0, 20.0);
}

void floods_replies(BreachedLine& line, RawFrame& frame) {
    RawFrame reply{.type = glp_frame_reply, .payload = Bytes(8, 0)};
    for (unsigned i = 0; i < 300; ++i) {
        reply.payload[0] = static_cast<std::uint8_t>(i);
        reply.payload[4] = glp_frame_get_status;
        line.send(reply);
    }
    line.send(frame);
}

TEST_F(CaptureSession, AnAnswerIsFoundAmongAFloodOfOthers) {
    const Breach breach = frames_by(floods_replies);
    const auto source = tampered({.has_line = false}, breach);
    request_.configure.rate_mHz = 500'000;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_EQ(outcome->progress.config->rate_mHz, 500'000U);
    EXPECT_EQ(outcome->link.samples.missing, 0U);
}

// Of firmware that does not count what its sensor fails to give.
void never_samples(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_samples) { return; }
    if (frame.type == glp_frame_status) {
        const glp_frame seen{frame.type, frame.flags, 0, frame.payload.data(), frame.payload.size()};
        glp_device_status status{};
        ASSERT_EQ(glp_device_status_read(&seen, &status), glp_status_ok);
        status.next_index = 0;
        ASSERT_EQ(glp_device_status_write(&status, frame.payload.data(), frame.payload.size()),
                  frame.payload.size());
    }
    line.send(frame);
}
void samples_for_a_second(BreachedLine& line, RawFrame& frame) {
    if (frame.type != glp_frame_samples || ++line.noted <= 25) { line.send(frame); }
}

TEST_F(CaptureSession, BoardThatNeverSamplesEndsByTheClockAndIsNoSuccess) {
    const Breach breach = frames_by(never_samples);
    const auto source = tampered({}, breach);
    request_.silence_s = 0.2;
    request_.duration_s = 0.6;
    double silent_s = 0.0;
    const auto outcome = capture(*source, [&](const CaptureProgress& progress) {
        silent_s = std::max(silent_s, progress.silent_s);
        return true;
    });
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_GT(silent_s, 0.2);
    EXPECT_EQ(outcome->link.samples.good, 0U);
    EXPECT_GT(outcome->link.samples.missing, 0U);
    EXPECT_TRUE(outcome->data_lost());
    EXPECT_FALSE(loaded().decoder->report().complete());
}

TEST_F(CaptureSession, SamplesThatStopEndByTheClockAndAreNoSuccess) {
    const Breach breach = frames_by(samples_for_a_second);
    const auto source = tampered({}, breach);
    request_.silence_s = 0.2;
    request_.duration_s = 5.0;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_GT(outcome->link.samples.good, 500U);
    EXPECT_LT(outcome->link.samples.good, 2000U);
    EXPECT_GT(outcome->link.samples.missing, 10'000U) << "board time runs twenty times as fast";
    EXPECT_TRUE(outcome->data_lost());
}

TEST_F(CaptureSession, OldFileStaysUntilTheNewOneHasSamples) {
    std::ofstream(request_.path) << "last night's";
    request_.overwrite = true;
    {
        const auto source = BoardSource::create({.speaks_instead = Bytes{}});
        request_.hello_timeout_s = 0.3;
        EXPECT_FALSE(capture(*source).ok());
        EXPECT_EQ(read_whole_file(request_.path), "last night's") << "no board answered";
    }
    request_.hello_timeout_s = 5.0;
    {
        const Breach breach = frames_by(never_samples);
        const auto source = tampered({}, breach);
        request_.silence_s = 0.1;
        request_.duration_s = 0.2;
        const auto outcome = capture(*source);
        ASSERT_TRUE(outcome.ok()) << outcome.error().message;
        EXPECT_TRUE(outcome->kept_old);
        EXPECT_EQ(read_whole_file(request_.path), "last night's") << "no sample came";
    }
    const auto source = BoardSource::create({});
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_FALSE(outcome->kept_old);
    EXPECT_EQ(stored_stream(request_.path), source->delivered());
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path("")), {}), 1) << "and no other";
}

void turns_to_noise(BreachedLine& line, RawFrame& frame) {
    if (++line.noted < 40) {
        line.send(frame);
    } else {
        line.send_bytes(Bytes(500, static_cast<std::uint8_t>(line.noted % 7)));
    }
}

TEST_F(CaptureSession, NoiseWithoutEndIsALostDeviceAndNotACapture) {
    const Breach breach = frames_by(turns_to_noise);
    const auto source = tampered({}, breach);
    request_.duration_s = 3600.0;
    request_.idle_timeout_s = 0.3;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::device_lost);
    EXPECT_NE(outcome->error->message.find("bytes came that are no frames"), std::string::npos)
        << outcome->error->message;
    EXPECT_EQ(loaded().decoder->report().samples.good, outcome->link.samples.good);
}

void index_goes_astray(BreachedLine& line, RawFrame& frame) {
    if (frame.type == glp_frame_samples && ++line.noted > 5) { frame.payload[12] = 0x40; }  // 2^38
    line.send(frame);
}

TEST_F(CaptureSession, AnIndexGoneWrongIsNotTakenForTimeThatHasPassed) {
    const Breach breach = frames_by(index_goes_astray);
    const auto source = tampered({}, breach);
    request_.duration_s = 2.0;
    const auto outcome = capture(*source);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->end, CaptureEnd::complete);
    EXPECT_GE(outcome->link.samples.good, 1900U);
    EXPECT_TRUE(outcome->data_lost());
}

}  // namespace
}  // namespace gyrolog
