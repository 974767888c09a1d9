#include "analysis/plot/vector_file.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "analysis/plot/figure.hpp"

namespace gyrolog {
namespace {

Figure figure() {
    Curve curve;
    curve.x = {0.1, 1.0, 10.0};
    curve.y = {0.3, 0.1, 0.2};
    curve.lo = {0.2, 0.05, 0.1};
    curve.hi = {0.4, 0.15, 0.3};
    curve.stroke.colour = colours::blue;
    curve.stroke.dash_px = {8.0, 4.0};
    curve.marker = Marker::diamond;
    Panel panel;
    panel.x = {"averaging time (s)", ScaleKind::logarithmic, {}};
    panel.y = {"σ(τ) (°/s)", ScaleKind::logarithmic, {}};
    panel.curves = {curve};
    Figure figure;
    figure.title = "A figure <of> paper & ink";
    figure.panels = {panel};
    return figure;
}

std::string written(const Figure& figure, VectorFormat format) {
    const Rendering rendering = render(figure);
    EXPECT_TRUE(rendering.ok()) << rendering.problem;
    const auto bytes = encode_vector(rendering.drawing, format);
    return {bytes.begin(), bytes.end()};
}

// Not HasSubstr(): it would print the whole file.
bool holds(const std::string& file, std::string_view what) { return file.find(what) != std::string::npos; }

TEST(VectorFile, SvgHasThePhysicalSizeAndTheColours) {
    const std::string svg = written(figure(), VectorFormat::svg);
    EXPECT_TRUE(holds(svg, "<svg "));
    EXPECT_TRUE(holds(svg, "width=\"576pt\" height=\"396pt\"")) << "1600 x 1100 pixels, 200 an inch";
    EXPECT_TRUE(holds(svg, "rgb(0%,44.705882%,69.803922%)")) << "the curve's blue";
    EXPECT_TRUE(holds(svg, "stroke-dasharray:8,4")) << "the dash";
    EXPECT_TRUE(holds(svg, "<use ")) << "letters";
    EXPECT_FALSE(holds(svg, "<image")) << "pixels, where lines should be";
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(VectorFile, PdfHoldsItsFont) {
    const std::string pdf = written(figure(), VectorFormat::pdf);
    EXPECT_TRUE(pdf.starts_with("%PDF-"));
    EXPECT_TRUE(holds(pdf, "/MediaBox [ 0 0 576 396 ]"));
    // Bold and regular; each in one piece of what a PDF calls simple and one of what it calls composite.
    std::size_t fonts = 0;
    for (std::size_t at = pdf.find("/FontDescriptor\n"); at != std::string::npos;
         at = pdf.find("/FontDescriptor\n", at + 1)) {
        ++fonts;
    }
    EXPECT_GE(fonts, 1U) << "this test looks for the wrong word";
    EXPECT_LE(fonts, 4U);
    EXPECT_TRUE(holds(pdf, "DejaVuSans"));
    EXPECT_TRUE(holds(pdf, "/ToUnicode")) << "its text can be searched";
    EXPECT_FALSE(holds(pdf, "/Image"));
}

}  // namespace
}  // namespace gyrolog
