#include <csignal>
#include <cstring>

#include <gtest/gtest.h>
#include <gyrolog_protocol/crc.h>
#include <sys/time.h>
#include <unistd.h>

#include "wire.hpp"

namespace gyrolog {
namespace {

std::uint32_t crc_of(const WireBytes& bytes) { return glp_crc32(bytes.data(), bytes.size()); }

// The definition itself: one bit of the reflected polynomial at a time.
std::uint32_t crc_by_definition(const WireBytes& bytes) {
    std::uint32_t remainder = 0xFFFFFFFFU;
    for (const std::uint8_t byte : bytes) {
        remainder ^= byte;
        for (int bit = 0; bit < 8; ++bit) {
            remainder = (remainder >> 1U) ^ ((remainder & 1U) != 0 ? 0xEDB88320U : 0U);
        }
    }
    return ~remainder;
}

TEST(Crc32, GivesTheCheckValueOfItsCatalogueEntry) {
    const char* text = "123456789";
    EXPECT_EQ(glp_crc32(reinterpret_cast<const std::uint8_t*>(text), 9), 0xCBF43926U);
    EXPECT_EQ(glp_crc32(nullptr, 0), 0U);
}

TEST(Crc32, AgreesWithTheBitwiseDefinitionAtEveryLengthAndAlignment) {
    std::mt19937 random(1);
    const WireBytes bytes = random_bytes(random, 200);
    for (std::size_t begin = 0; begin < 9; ++begin) {
        for (std::size_t end = begin; end < 100; ++end) {
            const WireBytes part(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                                 bytes.begin() + static_cast<std::ptrdiff_t>(end));
            ASSERT_EQ(glp_crc32(bytes.data() + begin, end - begin), crc_by_definition(part));
        }
    }
}

TEST(Crc32, ContinuesAcrossAnyCut) {
    std::mt19937 random(2);
    const WireBytes bytes = random_bytes(random, 100);
    for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
        const std::uint32_t first = glp_crc32(bytes.data(), cut);
        EXPECT_EQ(glp_crc32_continue(first, bytes.data() + cut, bytes.size() - cut), crc_of(bytes));
    }
}

// Bytes with about one zero in `zero_every`; none for 0.
WireBytes bytes_with_zeros(std::mt19937& random, std::size_t size, unsigned zero_every) {
    WireBytes bytes(size);
    for (std::uint8_t& byte : bytes) {
        byte = static_cast<std::uint8_t>(1U + random() % 255U);
        if (zero_every != 0 && random() % zero_every == 0) { byte = 0; }
    }
    return bytes;
}

// A decoder that has lost its place can follow a code of 0 for ever: a test of it ends as a failure after
// this much processor time of its own. All of them together take less than a tenth of a second.
class Cobs : public testing::Test {
protected:
    static constexpr int limit_s = 2;

    Cobs() {
        previous_ = std::signal(SIGVTALRM, fail);
        set_limit(limit_s);
    }
    ~Cobs() override {
        set_limit(0);
        std::signal(SIGVTALRM, previous_);
    }

private:
    static void set_limit(int seconds) {
        const itimerval limit{{0, 0}, {seconds, 0}};
        setitimer(ITIMER_VIRTUAL, &limit, nullptr);
    }
    static void fail(int) {
        constexpr char message[] = "COBS: coding or decoding does not end\n";
        const ssize_t written = write(STDERR_FILENO, message, sizeof message - 1);
        _exit(written < 0 ? 2 : 1);
    }

    void (*previous_)(int) = SIG_DFL;
};

TEST_F(Cobs, EveryLengthOfABodyComesBackAndFitsItsBound) {
    std::mt19937 random(3);
    for (std::size_t size = 0; size <= GLP_FRAME_BODY_MAX; ++size) {
        for (const unsigned zero_every : {0U, 1U, 4U, 250U}) {
            const WireBytes plain = bytes_with_zeros(random, size, zero_every);
            WireBytes encoded = cobs_encoded(plain);
            ASSERT_EQ(std::memchr(encoded.data(), 0, encoded.size()), nullptr);
            ASSERT_LE(encoded.size(), GLP_FRAME_ENCODED_MAX);
            WireBytes decoded(size + 1);
            const glp_cobs_result result =
                glp_cobs_decode(encoded.data(), encoded.size(), decoded.data(), size);
            ASSERT_EQ(result.status, glp_status_ok);
            decoded.resize(result.size);
            ASSERT_EQ(decoded, plain);
            const glp_cobs_result in_place =
                glp_cobs_decode(encoded.data(), encoded.size(), encoded.data(), encoded.size());
            ASSERT_EQ(in_place.status, glp_status_ok);
            encoded.resize(in_place.size);
            ASSERT_EQ(encoded, plain);
        }
    }
}

// Longer than any frame, and into no byte more than it takes, also in place.
TEST_F(Cobs, LongBytesComeBackIntoAsMuchAsTheyTake) {
    std::mt19937 random(6);
    for (const std::size_t size : {1023U, 1024U, 1025U, 5000U}) {
        for (const unsigned zero_every : {0U, 1U, 4U, 250U, 1000U}) {
            const WireBytes plain = bytes_with_zeros(random, size, zero_every);
            WireBytes encoded = cobs_encoded(plain);
            WireBytes decoded(size);
            ASSERT_EQ(glp_cobs_decode(encoded.data(), encoded.size(), decoded.data(), size).size, size);
            ASSERT_EQ(decoded, plain);
            ASSERT_EQ(glp_cobs_decode(encoded.data(), encoded.size(), encoded.data(), size).size, size);
            encoded.resize(size);
            ASSERT_EQ(encoded, plain);
        }
    }
}

TEST_F(Cobs, NeverWritesPastTheCapacityAndSaysNoSpace) {
    std::mt19937 random(4);
    for (const unsigned zero_every : {0U, 2U, 300U}) {
        const WireBytes plain = bytes_with_zeros(random, 600, zero_every);
        const WireBytes encoded = cobs_encoded(plain);
        for (std::size_t capacity = 0; capacity < encoded.size(); ++capacity) {
            WireBytes out(capacity);  // the sanitizers watch its end
            EXPECT_EQ(glp_cobs_encode(plain.data(), plain.size(), out.data(), capacity).status,
                      glp_status_no_space);
        }
        for (std::size_t capacity = 0; capacity < plain.size(); ++capacity) {
            WireBytes out(capacity);
            EXPECT_EQ(glp_cobs_decode(encoded.data(), encoded.size(), out.data(), capacity).status,
                      glp_status_no_space);
        }
    }
}

TEST_F(Cobs, NoTwoFormsDecodeToTheSameBytes) {
    // Every form of up to four bytes out of an alphabet that reaches all cases but the full group, which the
    // vectors cover: what decodes is exactly what encodes back to it. 1296 = 6^4 choices of four letters.
    const WireBytes alphabet = {0x00, 0x01, 0x02, 0x03, 0x04, 0xFF};
    int accepted = 0;
    for (std::size_t number = 0; number < 1296; ++number) {
        for (std::size_t size = 1; size <= 4; ++size) {
            WireBytes encoded;
            for (std::size_t i = 0, rest = number; i < size; ++i, rest /= 6) {
                encoded.push_back(alphabet[rest % 6]);
            }
            WireBytes plain(8);
            const glp_cobs_result result = glp_cobs_decode(encoded.data(), size, plain.data(), plain.size());
            if (result.status != glp_status_ok) { continue; }
            ++accepted;
            plain.resize(result.size);
            EXPECT_EQ(cobs_encoded(plain), encoded);
        }
    }
    EXPECT_GT(accepted, 100);
}

glp_status decode(const WireBytes& encoded) {
    WireBytes body(GLP_FRAME_BODY_MAX);
    glp_frame frame{};
    return glp_frame_decode(encoded.data(), encoded.size(), body.data(), &frame);
}

TEST(Frame, KeepsEveryFieldAtEveryPayloadLength) {
    std::mt19937 random(5);
    for (std::size_t size = 0; size <= GLP_FRAME_PAYLOAD_MAX; size += 1 + size / 40) {
        const WireBytes payload = random_bytes(random, size);
        const glp_frame frame{0x42, 0xA55A, 0xDEADBEEFU, payload.data(), payload.size()};
        WireBytes wire(GLP_FRAME_WIRE_MAX);
        wire.resize(glp_frame_encode(&frame, wire.data(), wire.size()).size);
        ASSERT_GE(wire.size(), GLP_FRAME_BODY_MIN + 3);
        EXPECT_EQ(wire.front(), 0);
        EXPECT_EQ(wire.back(), 0);
        WireBytes body(GLP_FRAME_BODY_MAX);
        glp_frame back{};
        ASSERT_EQ(glp_frame_decode(wire.data() + 1, wire.size() - 2, body.data(), &back), glp_status_ok);
        EXPECT_EQ(back.type, 0x42);
        EXPECT_EQ(back.flags, 0xA55A);
        EXPECT_EQ(back.sequence, 0xDEADBEEFU);
        EXPECT_EQ(WireBytes(back.payload, back.payload + back.payload_bytes), payload);
    }
}

TEST(Frame, RefusesAPayloadThatIsTooLongOrABufferThatIsTooSmall) {
    const WireBytes payload(GLP_FRAME_PAYLOAD_MAX + 1);
    WireBytes wire(GLP_FRAME_WIRE_MAX);
    glp_frame frame{1, 0, 0, payload.data(), payload.size()};
    EXPECT_EQ(glp_frame_encode(&frame, wire.data(), wire.size()).status, glp_status_bad_length);
    frame.payload_bytes = 10;
    const std::size_t needed = glp_frame_encode(&frame, wire.data(), wire.size()).size;
    for (std::size_t capacity = 0; capacity < needed; ++capacity) {
        WireBytes small(capacity);
        EXPECT_EQ(glp_frame_encode(&frame, small.data(), capacity).status, glp_status_no_space);
    }
}

TEST(Frame, EverySingleBitFlipIsRefused) {
    std::mt19937 random(6);
    for (const std::size_t size : {0U, 48U, 1004U}) {
        const WireBytes wire = frame_on_wire(glp_frame_status, 7, random_bytes(random, size));
        const WireBytes encoded(wire.begin() + 1, wire.end() - 1);
        ASSERT_EQ(decode(encoded), glp_status_ok);
        for (std::size_t bit = 0; bit < 8 * encoded.size(); ++bit) {
            WireBytes damaged = encoded;
            damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
            ASSERT_NE(decode(damaged), glp_status_ok) << "bit " << bit;
        }
    }
}

TEST(Frame, EveryTruncationIsRefused) {
    std::mt19937 random(7);
    const WireBytes wire = frame_on_wire(glp_frame_samples, 7, random_bytes(random, 300));
    for (std::size_t size = 0; size < wire.size() - 2; ++size) {
        EXPECT_NE(decode(WireBytes(wire.begin() + 1, wire.begin() + 1 + static_cast<std::ptrdiff_t>(size))),
                  glp_status_ok);
    }
}

}  // namespace
}  // namespace gyrolog
