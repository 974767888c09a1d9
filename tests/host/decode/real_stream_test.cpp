// A real board's byte stream that knows nothing of our frames: noise to the decoder, of which every byte is
// accounted for; and the same stream between our frames, none of which may be lost to it.
#include <array>
#include <cstdio>
#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/host/decode/made_stream.hpp"
#include "tests/support/needs.hpp"

namespace gyrolog {
namespace {

Bytes real_stream() {
    if (!has_shared_data()) { return {}; }
    const std::string command = "xz -dc '" + shared_data("mimu8_array/exp1_frames.bin.xz") + "'";
    Bytes bytes;
    FILE* pipe = popen(command.c_str(), "r");  // NOLINT(cert-env33-c): a fixed command on a path of the build
    if (pipe == nullptr) { return {}; }
    std::array<std::uint8_t, 65536> part{};
    for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;) {
        bytes.insert(bytes.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(got));
    }
    pclose(pipe);
    return bytes;
}

class RealStream : public testing::Test {
protected:
    static void SetUpTestSuite() { stream_ = new Bytes(real_stream()); }
    static void TearDownTestSuite() {
        delete stream_;
        stream_ = nullptr;
    }
    void SetUp() override {
        if (!has_shared_data()) { GTEST_SKIP() << needs_shared_data; }
        if (!has_program("xz")) { GTEST_SKIP() << needs_program("xz"); }
        ASSERT_FALSE(stream_->empty());
    }

    static Bytes* stream_;
};

Bytes* RealStream::stream_ = nullptr;

TEST_F(RealStream, BalancesToTheByteAndHoldsNoFrameOfOurs) {
    StreamDecoder decoder;
    decoder.feed(*stream_, {});
    const LinkReport report = decoder.report();
    EXPECT_EQ(report.bytes.total, stream_->size());
    EXPECT_TRUE(report.bytes.balanced());
    EXPECT_EQ(report.bytes.in_frames, 0U);
    EXPECT_EQ(report.frames.good, 0U);
    EXPECT_GT(report.frames.corrupted, 1000U);
    EXPECT_LE(report.bytes.buffered, std::uint64_t{GLP_FRAME_ENCODED_MAX} + 1);
}

TEST_F(RealStream, TwoHundredSlicesBetweenFramesCostNoFrame) {
    std::mt19937 random(11);
    Listening link;
    link.begin();
    for (int i = 0; i < 200; ++i) {
        const std::size_t from = random() % stream_->size();
        const std::size_t size = std::min<std::size_t>(random() % 5000, stream_->size() - from);
        const auto begin = stream_->begin() + static_cast<std::ptrdiff_t>(from);
        link.hear(Bytes(begin, begin + static_cast<std::ptrdiff_t>(size)));
        link.hear_samples(1);
        const LinkReport report = link.decoder.report();
        ASSERT_TRUE(report.bytes.balanced()) << i;
        ASSERT_EQ(report.bytes.total, link.bytes) << i;
        ASSERT_EQ(report.frames.good, 4U + static_cast<unsigned>(i)) << i;
    }
    EXPECT_TRUE(link.decoder.report().complete());
}

}  // namespace
}  // namespace gyrolog
