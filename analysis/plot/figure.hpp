// A figure of one or more panels of curves, drawn without a display. Plain numbers in, a PNG out, and
// what encode_vector() makes an SVG or a PDF of; nobody who includes this sees OpenCV, FreeType or cairo.
//
// Plots of a row are equally wide, those of a column have the same left and right edges, and a row is as
// high as the largest share in it. A panel that spans its row has edges of its own.
//
// Values a scale cannot show (NaN, infinite, zero or less on a logarithmic scale) are left out and break
// their curve. A panel with nothing to show says "no data".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/colour.hpp"
#include "analysis/plot/drawing.hpp"
#include "analysis/plot/geometry.hpp"
#include "analysis/plot/scale.hpp"
#include "analysis/plot/stroke.hpp"
#include "analysis/plot/typeface.hpp"

namespace gyrolog {

enum class CurveShape {
    straight,  // from point to point
    steps,     // each value holds to the next x: histograms
};

struct Curve {
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> lo;  // a band from lo to hi; both empty, or as long as x
    std::vector<double> hi;
    CurveShape shape = CurveShape::straight;
    Stroke stroke;
    Marker marker = Marker::none;
    double marker_size_px = 9.0;
    double marker_outline_px = 1.0;  // of paper
    double markers_apart_px = 26.0;  // closer ones are left out
    double band_opacity = 0.18;
    bool sets_range = true;  // false: drawn where it crosses what the others show, such as a slope line
    std::vector<std::string> legend;  // the row's cells, the first is the name; empty: not in the legend
};

// A marked point with a word beside it. The word may be empty, and is left out where there is no room; the
// marker never is.
struct Callout {
    double x = 0.0;
    double y = 0.0;
    std::string text;
    Colour colour = colours::ink;
    Marker marker = Marker::circle;
    std::optional<Colour> word_colour{};  // absent: the marker's
    bool is_level = false;  // the word stands to the right of the point, on its level, or not at all
};

// A value of x worth marking across the panel, with a word above it, "1 s", unless another guide's word is
// there.
struct Guide {
    double x = 0.0;
    std::string text;
};

struct AxisName {
    double value = 0.0;
    std::string text;
};

struct AxisSpec {
    std::string title;  // quantity and unit
    ScaleKind kind = ScaleKind::linear;
    std::optional<Range> range;     // absent: from the data
    std::vector<AxisName> names{};  // rising; words in place of numbers
};

// The same y values in another unit, along the right-hand side.
struct SecondUnit {
    std::string title;
    double factor = 1.0;  // right-hand value = left-hand value * factor; positive
};

enum class LegendPlace {
    in_plot,  // where it covers no data, or else below
    beside,   // to the right, where there is room for a plot as well; else as in_plot
};

struct Panel {
    AxisSpec x;
    AxisSpec y;
    std::optional<SecondUnit> right;
    std::vector<Curve> curves;
    std::vector<Callout> callouts;
    std::vector<Guide> guides;
    std::vector<std::string> legend_header;  // over the legend's columns; may be empty
    std::vector<std::string> notes;          // lines of text below the legend
    LegendPlace legend_place = LegendPlace::in_plot;
    std::string caption;        // above the plot
    double height_share = 1.0;  // of the figure's height, against the other rows' panels
    bool spans_row = false;     // has a row to itself
};

// A title that all panels of a row have stands at the first one.
void share_titles(std::vector<Panel>& panels, std::size_t columns);

// A longer record has hours on its time axis.
inline constexpr double hours_from_s = 7200.0;

struct Figure {
    std::string title;
    std::string source;  // where the data came from; shortened in its middle when the line is too long
    std::vector<std::string> facts;  // follow the source, broken into lines between facts
    std::vector<Panel> panels;       // row by row from the top
    std::vector<Curve> key;          // curves without points: one legend of all panels, below them
    int columns = 1;
    int width_px = 1600;
    int height_px = 1100;
    // Of letters and strokes; 2 with twice the pixels gives the same picture, finer. On paper, letters are of
    // one size: the scale says how many pixels an inch has (paper_size.hpp).
    double scale = 1.0;
    std::string font_directory{Typeface::debian_directory};
};

// Where things came to lie, for whoever wants to point at the picture.
struct PanelPlace {
    Box plot;
    Scale x;
    Scale y;
    std::optional<Box> legend;
    std::vector<Box> words;   // labels of callouts and guides
    std::vector<Box> labels;  // of ticks
};

struct Rendering {
    std::vector<std::uint8_t> png;
    Drawing drawing;  // the same, for encode_vector()
    std::vector<PanelPlace> panels;
    std::optional<Box> key;
    std::string problem;  // what went wrong and the mend; then there is no PNG

    bool ok() const { return problem.empty(); }
};

// At most 16 384 x 16 384 pixels, at least what the letters need at that scale; scales from 0.1 to 20.
Rendering render(const Figure& figure);

}  // namespace gyrolog
