// The picture being drawn. Shapes go on a sheet twice as fine in both directions and are averaged at the end,
// so that widths in half pixels and antialiased joins come out even; text is laid over them at the picture's
// own resolution, where its hinting counts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "analysis/plot/colour.hpp"
#include "analysis/plot/drawing.hpp"
#include "analysis/plot/geometry.hpp"
#include "analysis/plot/stroke.hpp"
#include "analysis/plot/typeface.hpp"

namespace gyrolog {

enum class Across { left, centre, right };   // which part of the line of text is at the point
enum class Along { top, middle, baseline };  // capitals' top, capitals' middle, baseline

struct TextStyle {
    double size_px = 16.0;
    Colour colour = colours::ink;
    Across across = Across::left;
    Along along = Along::baseline;
    bool upwards = false;  // reads from bottom to top; across and along turn with it
};

class Canvas {
public:
    Canvas(int width_px, int height_px, double dpi);

    void fill(const Box& box, Colour colour, double opacity = 1.0);
    void fill(const Polyline& polygon, Colour colour, double opacity = 1.0);
    void line(const Polyline& line, const Stroke& stroke);
    void rule(Point from, Point to, double width_px, Colour colour);  // upright or level, on whole pixels
    void marker(Point at, Marker marker, double size_px, Colour colour, double outline_px);
    Box text(const Typeface& typeface, std::string_view text, Point at,
             const TextStyle& style);  // returns the ink's

    cv::Mat picture() const;  // 8 bits, blue green red
    const Drawing& drawing() const { return drawing_; }

private:
    struct Lettering {
        TextMask mask;
        Colour colour;
    };

    cv::Mat fine_;
    std::vector<Lettering> letterings_;
    Drawing drawing_;
};

// The file says how large it is to be printed.
std::vector<std::uint8_t> encode_png(const cv::Mat& picture, double dpi);

}  // namespace gyrolog
