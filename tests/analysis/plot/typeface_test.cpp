#include "analysis/plot/typeface.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include <gtest/gtest.h>

namespace gyrolog {
namespace {

class Sans : public testing::Test {
protected:
    void SetUp() override {
        std::string problem;
        auto opened =
            Typeface::open(std::filesystem::path(Typeface::debian_directory) / "DejaVuSans.ttf", problem);
        ASSERT_TRUE(opened.has_value()) << problem;
        face = std::move(opened);
    }
    double width(const std::string& text) const { return face->measure(text, 20.0).width_px; }
    std::optional<Typeface> face;
};

TEST(Typeface, AMissingFontIsNamedWithItsMend) {
    std::string problem;
    EXPECT_FALSE(Typeface::open("/nowhere/DejaVuSans.ttf", problem).has_value());
    EXPECT_EQ(problem,
              "open font '/nowhere/DejaVuSans.ttf': not found or not a font; install fonts-dejavu-core");
}

TEST_F(Sans, HasEveryCharacterTheFiguresUse) {
    for (const char32_t character : std::u32string(U"στ√°²½−×·–…∞⁰¹²³⁴⁵⁶⁷⁸⁹⁻()/")) {
        EXPECT_TRUE(face->has(character)) << static_cast<unsigned>(character);
    }
    EXPECT_FALSE(face->has(U'\u4E2D'));
}

TEST_F(Sans, KerningDrawsLettersTogether) { EXPECT_LT(width("AV"), width("A") + width("V") - 0.5); }

TEST_F(Sans, ExtentGrowsInProportionToTheSize) {
    const TextExtent small = face->measure("σ(τ) (°/s)", 20.0);
    const TextExtent large = face->measure("σ(τ) (°/s)", 200.0);
    EXPECT_NEAR(large.width_px, 10.0 * small.width_px, 1e-3 * large.width_px);
    EXPECT_NEAR(large.ascent_px, 10.0 * small.ascent_px, 15.0);  // hinting moves heights by up to a pixel
}

TEST_F(Sans, InkStaysWithinItsExtent) {
    for (const std::string text : {"10⁻³", "averaging time τ (s)", "jpqy", "∞"}) {
        for (const double fraction_px : {0.0, 0.25, 0.75}) {
            const TextExtent extent = face->measure(text, 21.0);
            const TextMask mask = face->render(text, 21.0, fraction_px);
            EXPECT_GE(-mask.top_px, extent.ascent_px - 1.0);
            EXPECT_LE(-mask.top_px, extent.ascent_px + 1.0);
            EXPECT_LE(mask.top_px + mask.height_px, extent.descent_px + 1.0);
            EXPECT_GE(mask.left_px, -2);
            EXPECT_LE(mask.left_px + mask.width_px, extent.width_px + fraction_px + 2.0);
        }
    }
}

TEST_F(Sans, AFractionOfAPixelMovesTheInkByThatMuch) {
    const auto centre_px = [&](double fraction_px) {
        const TextMask mask = face->render("l", 40.0, fraction_px);
        double weight = 0.0, moment = 0.0;
        for (int i = 0; i < mask.width_px * mask.height_px; ++i) {
            const double covered = mask.coverage[static_cast<std::size_t>(i)];
            weight += covered;
            moment += covered * (mask.left_px + i % mask.width_px);
        }
        return moment / weight;
    };
    EXPECT_NEAR(centre_px(0.5) - centre_px(0.0), 0.5, 0.03);
}

TEST_F(Sans, ATurnedMaskHoldsTheSameInk) {
    const TextMask level = face->render("Lτ", 30.0);
    const TextMask turned = level.turned_left();
    EXPECT_EQ(turned.width_px, level.height_px);
    EXPECT_EQ(turned.height_px, level.width_px);
    EXPECT_EQ(std::accumulate(level.coverage.begin(), level.coverage.end(), 0L),
              std::accumulate(turned.coverage.begin(), turned.coverage.end(), 0L));
    // The stem of the L, leftmost column when level, is the lowest row when turned.
    const auto last_row = turned.coverage.end() - turned.width_px;
    EXPECT_GT(std::accumulate(last_row, turned.coverage.end(), 0L), 0L);
    EXPECT_EQ(turned.left_px, level.top_px);
    EXPECT_EQ(turned.top_px + turned.height_px, -level.left_px);
}

TEST_F(Sans, ShortensToTheWidthAskedFor) {
    const std::string name = "recording of the third night with the window open.pcapng";
    for (double width_px = 20.0; width_px < 700.0; width_px += 13.0) {
        const std::string end = face->shortened(name, 20.0, width_px, Ellipsis::end);
        const std::string middle = face->shortened(name, 20.0, width_px, Ellipsis::middle);
        EXPECT_LE(width(end), width_px);
        EXPECT_LE(width(middle), width_px);
        if (width_px > width(name)) { EXPECT_EQ(middle, name); }
    }
    EXPECT_TRUE(face->shortened(name, 20.0, 200.0, Ellipsis::middle).ends_with("ng"));
    EXPECT_TRUE(face->shortened(name, 20.0, 200.0, Ellipsis::end).starts_with("recording"));
    EXPECT_EQ(face->shortened(name, 20.0, 5.0, Ellipsis::end), "");
}

TEST_F(Sans, EmptyAndBlankTextHaveNoInk) {
    EXPECT_TRUE(face->render("", 20.0).coverage.empty());
    EXPECT_TRUE(face->render("   ", 20.0).coverage.empty());
    EXPECT_GT(width("   "), 0.0);
}

TEST(Utf8, RoundTripsEveryLengthOfSequence) {
    const std::string text = "a°τ…𝜎";
    EXPECT_EQ(decode_utf8(text), U"a°τ…𝜎");
    EXPECT_EQ(encode_utf8(decode_utf8(text)), text);
}

TEST(Utf8, ReplacesWhatIsNoUtf8AndGoesOn) {
    EXPECT_EQ(decode_utf8("a\xFFz"), U"a\uFFFDz");
    EXPECT_EQ(decode_utf8("a\xCF"), U"a\uFFFD");
    EXPECT_EQ(decode_utf8("\xC0\xAF"), U"\uFFFD\uFFFD");  // overlong
    EXPECT_EQ(decode_utf8("\xED\xA0\x80"), U"\uFFFD");    // a surrogate
    EXPECT_EQ(decode_utf8("a\nb"), U"a\uFFFDb");
}

}  // namespace
}  // namespace gyrolog
