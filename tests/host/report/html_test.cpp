#include "host/report/html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/report/base64.hpp"

namespace gyrolog {
namespace {

std::string base64_of(std::string_view text) {
    return base64(std::vector<std::uint8_t>(text.begin(), text.end()));
}

// RFC 4648, section 10, and every bit of a byte.
TEST(Base64, IsThatOfTheStandard) {
    EXPECT_EQ(base64_of(""), "");
    EXPECT_EQ(base64_of("f"), "Zg==");
    EXPECT_EQ(base64_of("fo"), "Zm8=");
    EXPECT_EQ(base64_of("foo"), "Zm9v");
    EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
    EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64(std::vector<std::uint8_t>{0xFB, 0xEF, 0xBE, 0xFF}), "++++/w==");
}

TEST(Html, OfTextIsTheTextAndNoMarkup) {
    EXPECT_EQ(Html::text(R"(<b>&"')").str(), "&lt;b&gt;&amp;&quot;&#39;");
    EXPECT_EQ(Html::text("25 °C, √Hz").str(), "25 °C, √Hz");
    // A mark that turns the direction of what follows, and a byte that is no UTF-8.
    EXPECT_EQ(Html::text("a\u202Eb\xFF").str(), "a\\u202eb\\xff");
}

TEST(Html, OfAPictureTakesNoMarkupFromItsDescription) {
    const std::vector<std::uint8_t> png{'f', 'o', 'o'};
    EXPECT_EQ(png_image(png, R"(x" onload="y)").str(),
              R"(<img alt="x&quot; onload=&quot;y" src="data:image/png;base64,Zm9v">)");
    EXPECT_TRUE(figure({}, "nothing", "no picture").empty());
}

TEST(Html, FigureInPartsHasOneCaption) {
    const std::vector<std::vector<std::uint8_t>> pngs{{'f', 'o', 'o'}, {'b', 'a', 'r'}};
    const std::string parts = figure_in_parts(pngs, "samples", "The samples.").str();
    EXPECT_THAT(parts, testing::HasSubstr(R"(alt="samples, 1 of 2")"));
    EXPECT_THAT(parts, testing::HasSubstr(R"(alt="samples, 2 of 2")"));
    EXPECT_EQ(parts.find("<figcaption>"), parts.rfind("<figcaption>"));
    EXPECT_TRUE(figure_in_parts({}, "nothing", "no picture").empty());
}

TEST(Html, RowOfOneCellSpansTheTable) {
    HtmlTable rows{cells_of({"unit", "x", "y"}), {}};
    rows.rows.push_back(cells_of({"N"}));
    rows.rows.push_back(cells_of({"rad", "1", "2"}));
    const std::string markup = table(rows).str();
    EXPECT_NE(markup.find(R"(<th scope="colgroup" colspan="3">N</th>)"), std::string::npos) << markup;
    EXPECT_NE(markup.find(R"(<th scope="row">rad</th><td>1</td>)"), std::string::npos) << markup;
    EXPECT_NE(markup.find(R"(<th scope="col">y</th>)"), std::string::npos) << markup;
}

}  // namespace
}  // namespace gyrolog
