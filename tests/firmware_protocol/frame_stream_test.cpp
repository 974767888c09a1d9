#include <set>

#include <gtest/gtest.h>

#include "wire.hpp"

namespace gyrolog {
namespace {

struct Seen {
    std::vector<std::uint32_t> sequences;
    glp_stream stream{};
};

Seen read_in_pieces(const WireBytes& bytes, const std::vector<std::size_t>& cuts) {
    Seen seen;
    glp_stream_init(&seen.stream);
    std::size_t at = 0;
    const auto keep = [&seen](const glp_frame& frame) { seen.sequences.push_back(frame.sequence); };
    for (const std::size_t cut : cuts) {
        feed(seen.stream, bytes.data() + at, cut - at, keep);
        EXPECT_TRUE(accounts_hold(seen.stream));
        at = cut;
    }
    feed(seen.stream, bytes.data() + at, bytes.size() - at, keep);
    EXPECT_TRUE(accounts_hold(seen.stream));
    return seen;
}

void expect_same(const Seen& a, const Seen& b) {
    EXPECT_EQ(a.sequences, b.sequences);
    EXPECT_EQ(a.stream.bytes_in_frames, b.stream.bytes_in_frames);
    EXPECT_EQ(a.stream.bytes_skipped, b.stream.bytes_skipped);
    for (int reason = 0; reason < glp_status_count; ++reason) {
        EXPECT_EQ(a.stream.rejected[reason], b.stream.rejected[reason]) << reason;
    }
}

// Frames, noise, an overlong run and a torn frame.
WireBytes eventful_stream() {
    std::mt19937 random(11);
    WireBytes bytes;
    const auto append = [&bytes](const WireBytes& more) {
        bytes.insert(bytes.end(), more.begin(), more.end());
    };
    append(random_bytes(random, 40));
    append(frame_on_wire(glp_frame_status, 1, random_bytes(random, 48)));
    append(frame_on_wire(glp_frame_samples, 2, WireBytes(100, 0)));
    append(random_bytes(random, 100));
    append(WireBytes(1100, 0x31));
    append(frame_on_wire(glp_frame_samples, 3, random_bytes(random, 900)));
    append(WireBytes(5, 0));
    WireBytes torn = frame_on_wire(glp_frame_samples, 4, random_bytes(random, 200));
    torn.resize(120);
    append(torn);
    append(frame_on_wire(glp_frame_event, 5, random_bytes(random, 24)));
    return bytes;
}

TEST(FrameStream, YieldsTheSameHoweverTheBytesAreCut) {
    const WireBytes bytes = eventful_stream();
    const Seen whole = read_in_pieces(bytes, {});
    EXPECT_EQ(whole.sequences, (std::vector<std::uint32_t>{1, 2, 3, 5}));
    std::vector<std::size_t> every_byte;
    for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
        expect_same(read_in_pieces(bytes, {cut}), whole);
        every_byte.push_back(cut);
    }
    expect_same(read_in_pieces(bytes, every_byte), whole);
}

TEST(FrameStream, NamesTheReasonOfEachRefusal) {
    const Seen seen = read_in_pieces(eventful_stream(), {});
    EXPECT_EQ(seen.stream.frames, 4U);
    EXPECT_EQ(seen.stream.rejected[glp_status_bad_length], 1U);  // the overlong run
    EXPECT_GE(seen.stream.rejected[glp_status_bad_cobs], 2U);    // noise, and the torn frame
}

TEST(FrameStream, APayloadStaysValidUntilTheNextCall) {
    std::mt19937 random(12);
    const WireBytes payload = random_bytes(random, 500);
    WireBytes bytes = frame_on_wire(glp_frame_samples, 1, payload);
    for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{200}, bytes.size() - 1}) {
        glp_stream stream;
        glp_stream_init(&stream);
        glp_frame frame{};
        bool have_frame = false;
        WireBytes head(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(first));
        WireBytes tail(bytes.begin() + static_cast<std::ptrdiff_t>(first), bytes.end());
        glp_stream_push(&stream, head.data(), head.size(), &frame, &have_frame);
        EXPECT_FALSE(have_frame);
        glp_stream_push(&stream, tail.data(), tail.size(), &frame, &have_frame);
        ASSERT_TRUE(have_frame);
        std::fill(head.begin(), head.end(), std::uint8_t{0xEE});  // the caller's bytes may go away
        std::fill(tail.begin(), tail.end(), std::uint8_t{0xEE});
        EXPECT_EQ(WireBytes(frame.payload, frame.payload + frame.payload_bytes), payload);
    }
}

TEST(FrameStream, EverySingleBitFlipCostsTheTouchedFramesAndInventsNone) {
    WireBytes bytes;
    for (std::uint32_t sequence = 0; sequence < 3; ++sequence) {
        const WireBytes wire = frame_on_wire(glp_frame_status, sequence, WireBytes(48, 0x5A));
        bytes.insert(bytes.end(), wire.begin(), wire.end());
    }
    const std::set<std::uint32_t> sent{0, 1, 2};
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        WireBytes damaged = bytes;
        damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
        const Seen seen = read_in_pieces(damaged, {});
        EXPECT_GE(seen.sequences.size(), 2U) << "bit " << bit;
        EXPECT_LE(seen.sequences.size(), 3U) << "bit " << bit;
        for (const std::uint32_t sequence : seen.sequences) { EXPECT_TRUE(sent.contains(sequence)); }
    }
}

enum class Damage { flip_bit, drop_byte, drop_block, double_block, zero_block, stale_block };

void damage(WireBytes& bytes, std::size_t at, Damage kind, std::mt19937& random) {
    constexpr std::ptrdiff_t block = 64;  // a packet of full speed
    const auto here = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (kind) {
        case Damage::flip_bit:
            *here ^= static_cast<std::uint8_t>(1U << (random() % 8));
            break;
        case Damage::drop_byte:
            bytes.erase(here);
            break;
        case Damage::drop_block:
            bytes.erase(here, here + block);
            break;
        case Damage::double_block: {
            const WireBytes twice(here, here + block);
            bytes.insert(here + block, twice.begin(), twice.end());
            break;
        }
        case Damage::zero_block:
            std::fill(here, here + block, std::uint8_t{0});
            break;
        case Damage::stale_block:
            std::copy(here - 4096, here - 4096 + block, here);
            break;
    }
}

class DamagedStream : public testing::TestWithParam<Damage> {};

// Events that do not share a frame. A block of 64 bytes touches 1 + 63/228 = 1.28 frames of 228 bytes on
// average; with 4000 events that mean is known to 0.007.
TEST_P(DamagedStream, LosesLittleMoreThanTheTouchedFramesAndAcceptsNothingFalse) {
    constexpr std::uint32_t spacing = 5;
    constexpr std::uint32_t events = 4000;
    constexpr std::uint32_t before_first = 20;  // a stale block comes from 4096 bytes back
    constexpr std::uint32_t frames = before_first + events * spacing;
    std::mt19937 random(static_cast<unsigned>(GetParam()) + 100U);
    std::vector<WireBytes> payloads;
    WireBytes bytes;
    std::vector<std::size_t> begins;
    for (std::uint32_t sequence = 0; sequence < frames; ++sequence) {
        payloads.push_back(random_bytes(random, 212));
        const WireBytes wire = frame_on_wire(glp_frame_samples, sequence, payloads.back());
        begins.push_back(bytes.size());
        bytes.insert(bytes.end(), wire.begin(), wire.end());
    }
    // From the back, so that positions in front stay where they are.
    for (std::uint32_t event = events; event > 0; --event) {
        const std::uint32_t frame = before_first + event * spacing - 2;
        const std::size_t at = begins[frame] + random() % (begins[frame + 1] - begins[frame]);
        damage(bytes, at, GetParam(), random);
    }
    glp_stream stream;
    glp_stream_init(&stream);
    std::set<std::uint32_t> good;
    feed(stream, bytes.data(), bytes.size(), [&](const glp_frame& frame) {
        ASSERT_LT(frame.sequence, frames);
        ASSERT_EQ(WireBytes(frame.payload, frame.payload + frame.payload_bytes), payloads[frame.sequence]);
        good.insert(frame.sequence);
    });
    EXPECT_LE(static_cast<double>(frames - good.size()) / events, 1.3);
    EXPECT_GE(static_cast<double>(frames - good.size()) / events,
              GetParam() == Damage::double_block ? 0.5 : 0.9);
    EXPECT_TRUE(accounts_hold(stream));
}

INSTANTIATE_TEST_SUITE_P(Kinds, DamagedStream,
                         testing::Values(Damage::flip_bit, Damage::drop_byte, Damage::drop_block,
                                         Damage::double_block, Damage::zero_block, Damage::stale_block));

}  // namespace
}  // namespace gyrolog
