#include "analysis/plot/vector_file.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "analysis/plot/figure.hpp"
#include "analysis/plot/paper_size.hpp"

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
    const PaperSize paper;
    figure.width_px = paper.width_px();
    figure.height_px = paper.pixels(100.0);
    figure.scale = paper.scale();
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
    EXPECT_TRUE(holds(svg, "width=\"510.24pt\" height=\"283.44pt\""))
        << "180 x 100 mm: " << svg.substr(0, 200);
    EXPECT_TRUE(holds(svg, "rgb(0%,44.705882%,69.803922%)")) << "the curve's blue";
    EXPECT_TRUE(holds(svg, "stroke-dasharray:14.03")) << "the dash, 8 pixels at scale 1";
    EXPECT_TRUE(holds(svg, "<use ")) << "letters";
    EXPECT_FALSE(holds(svg, "<image")) << "pixels, where lines should be";
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(VectorFile, PdfHoldsItsFont) {
    const std::string pdf = written(figure(), VectorFormat::pdf);
    EXPECT_TRUE(pdf.starts_with("%PDF-"));
    EXPECT_TRUE(holds(pdf, "/MediaBox [ 0 0 510.24 283.44 ]"));
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
