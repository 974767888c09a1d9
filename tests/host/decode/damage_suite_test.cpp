// Damage of every kind that a link does, a hundred thousand times (an eighth of that under a sanitizer), with
// the numbers that are promised: at most 1.3 good frames lost for each event, nothing false accepted, and
// what was lost counted exactly.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "tests/host/decode/made_stream.hpp"
#include "tests/support/instrumented.hpp"

namespace gyrolog {
namespace {

constexpr std::ptrdiff_t packet = 64;  // of USB full speed
constexpr std::uint32_t frames_per_event = 6;
constexpr std::uint32_t events_per_stream = 500;
constexpr std::uint32_t streams_per_kind = GYROLOG_IS_INSTRUMENTED ? 3 : 24;
constexpr double frames_lost_sd = 0.547;  // of one event, as measured: some damage nothing, some two frames

struct Damage {
    const char* name;
    std::size_t bytes_touched;  // neighbouring ones, whose frames are lost
    void (*hit)(Bytes& bytes, std::ptrdiff_t at, std::mt19937& random);
};

void exchange_packets(Bytes& bytes, std::ptrdiff_t at, std::mt19937& /*random*/) {
    const auto here = bytes.begin() + at;
    std::swap_ranges(here, here + packet, here + packet);
}

constexpr std::array damages = {
    Damage{"flipped bit", 1,
           [](Bytes& bytes, std::ptrdiff_t at, std::mt19937& random) {
               std::uint8_t& byte = bytes[static_cast<std::size_t>(at)];
               byte = static_cast<std::uint8_t>(byte ^ (1U << (random() % 8U)));
           }},
    Damage{"burst of 16 bits", 2,
           [](Bytes& bytes, std::ptrdiff_t at, std::mt19937& random) {
               for (std::size_t i = 0; i < 2; ++i) {
                   bytes[static_cast<std::size_t>(at) + i] = static_cast<std::uint8_t>(random());
               }
           }},
    Damage{
        "lost byte", 1,
        [](Bytes& bytes, std::ptrdiff_t at, std::mt19937& /*random*/) { bytes.erase(bytes.begin() + at); }},
    Damage{"inserted bytes", 1,
           [](Bytes& bytes, std::ptrdiff_t at, std::mt19937& random) {
               std::array<std::uint8_t, 3> some{};
               for (std::uint8_t& byte : some) { byte = static_cast<std::uint8_t>(random()); }
               const auto count = static_cast<std::ptrdiff_t>(1 + random() % some.size());
               bytes.insert(bytes.begin() + at, some.begin(), some.begin() + count);
           }},
    Damage{"lost packet", packet,
           [](Bytes& bytes, std::ptrdiff_t at, std::mt19937& /*random*/) {
               bytes.erase(bytes.begin() + at, bytes.begin() + at + packet);
           }},
    Damage{"doubled packet", packet,
           [](Bytes& bytes, std::ptrdiff_t at, std::mt19937& /*random*/) {
               const Bytes twice(bytes.begin() + at, bytes.begin() + at + packet);
               bytes.insert(bytes.begin() + at + packet, twice.begin(), twice.end());
           }},
    Damage{"packet of zeros", packet,
           [](Bytes& bytes, std::ptrdiff_t at, std::mt19937& /*random*/) {
               std::fill_n(bytes.begin() + at, packet, std::uint8_t{0});
           }},
    Damage{"stale packet", packet,
           [](Bytes& bytes, std::ptrdiff_t at, std::mt19937& /*random*/) {
               std::copy_n(bytes.begin() + at - 640, packet, bytes.begin() + at);
           }},
    // Two packets, and the one event touches the frames of both.
    Damage{"exchanged packets", 2 * packet, exchange_packets},
};

// Every sample accepted is the board's, at its own index.
class TruthJudge final : public MessageHandler {
public:
    std::uint64_t frames = 0;
    std::uint64_t false_accepts = 0;

private:
    void on_samples(const ReceivedFrame& /*frame*/, const glp_samples& samples) override {
        ++frames;
        bool same = samples.count == 16 && samples.first_index % 16 == 0;
        const std::size_t fields = glp_sample_bytes(samples.layout) / 2;
        for (std::size_t i = 0; same && i < samples.count; ++i) {
            for (std::size_t field = 0; field < fields; ++field) {
                same = same &&
                       glp_sample_field(&samples, i, field) == made_value(samples.first_index + i, field);
            }
        }
        false_accepts += same ? 0 : 1;
    }
    void on_unknown(const ReceivedFrame& /*frame*/) override { ++false_accepts; }
    void on_malformed(const ReceivedFrame& /*frame*/, glp_status /*reason*/) override { ++false_accepts; }
    void on_event(const ReceivedFrame& /*frame*/, const glp_event& /*event*/) override { ++false_accepts; }
    void on_reply(const ReceivedFrame& /*frame*/, const glp_reply& /*reply*/) override { ++false_accepts; }
};

struct Tally {
    std::uint64_t events = 0;
    std::uint64_t frames_sent = 0;
    std::uint64_t frames_lost = 0;
    std::uint64_t false_accepts = 0;
};

void run_stream(const Damage& damage, std::uint32_t seed, Tally& tally) {
    std::mt19937 random(seed);
    MadeBoard board;
    TruthJudge judge;
    StreamDecoder decoder({.keep_samples = false, .observer = &judge});
    std::uint64_t fed = 0;
    const auto feed = [&](const Bytes& bytes) {
        decoder.feed(bytes, board.now());
        fed += bytes.size();
    };
    feed(board.hello_frame());
    feed(board.config_frame());
    feed(board.samples_frame(glp_flag_first_after_start));
    Bytes stream;
    std::vector<std::size_t> begins;
    const std::uint32_t frames = (events_per_stream + 1) * frames_per_event;
    stream.reserve(frames * 250);
    begins.reserve(frames);
    for (std::uint32_t i = 0; i < frames; ++i) {
        begins.push_back(stream.size());
        const Bytes wire = board.samples_frame();
        stream.insert(stream.end(), wire.begin(), wire.end());
    }
    // From the back, so that what is in front stays in place; events share no frame.
    for (std::uint32_t event = events_per_stream; event > 0; --event) {
        const std::size_t begin = begins[event * frames_per_event - 2];
        const std::size_t length = begins[event * frames_per_event - 1] - begin;
        damage.hit(stream, static_cast<std::ptrdiff_t>(begin + random() % length), random);
    }
    feed(stream);
    const LinkReport report = decoder.report();
    const std::uint64_t sent = frames + 1;
    ASSERT_TRUE(report.bytes.balanced());
    ASSERT_EQ(report.bytes.total, fed);
    ASSERT_EQ(report.samples.good, 16 * judge.frames);
    ASSERT_EQ(report.frames.missing, sent - judge.frames) << "what was lost is counted";
    ASSERT_EQ(report.samples.missing, 16 * (sent - judge.frames));
    tally.events += events_per_stream;
    tally.frames_sent += sent;
    tally.frames_lost += sent - judge.frames;
    tally.false_accepts += judge.false_accepts;
}

TEST(DamageSuite, EventCostsAtMostOneFrameAndThreeTenthsAndNothingFalseIsAccepted) {
    MadeBoard board;
    static_cast<void>(board.samples_frame());
    const auto frame_bytes = static_cast<double>(board.samples_frame().size());
    Tally all;
    std::printf("frames of %.0f bytes; seeds 1 ... %u for each kind\n", frame_bytes, streams_per_kind);
    for (const Damage& damage : damages) {
        Tally tally;
        for (std::uint32_t seed = 1; seed <= streams_per_kind; ++seed) {
            run_stream(damage, seed, tally);
            if (testing::Test::HasFatalFailure()) { FAIL() << damage.name << ", seed " << seed; }
        }
        const double per_event = static_cast<double>(tally.frames_lost) / static_cast<double>(tally.events);
        std::printf("  %-18s %llu events, %.3f frames lost each, %llu false accepts\n", damage.name,
                    static_cast<unsigned long long>(tally.events), per_event,
                    static_cast<unsigned long long>(tally.false_accepts));
        // The frames that so many neighbouring bytes lie in, on average.
        const double touched = 1.0 + static_cast<double>(damage.bytes_touched - 1) / frame_bytes;
        EXPECT_LE(per_event, touched + 4.0 * frames_lost_sd / std::sqrt(static_cast<double>(tally.events)))
            << damage.name;
        EXPECT_EQ(tally.false_accepts, 0U) << damage.name;
        all.events += tally.events;
        all.frames_lost += tally.frames_lost;
        all.false_accepts += tally.false_accepts;
    }
    const double per_event = static_cast<double>(all.frames_lost) / static_cast<double>(all.events);
    std::printf("  all                %llu events, %.3f frames lost each, %llu false accepts\n",
                static_cast<unsigned long long>(all.events), per_event,
                static_cast<unsigned long long>(all.false_accepts));
    EXPECT_GE(all.events, damages.size() * streams_per_kind * events_per_stream);
    EXPECT_LE(per_event, 1.3);
    EXPECT_GE(per_event, 0.8) << "the damage did no damage";
    EXPECT_EQ(all.false_accepts, 0U);
}

}  // namespace
}  // namespace gyrolog
