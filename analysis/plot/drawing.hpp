// What a canvas was asked to draw, in its order: from this a figure is written in forms other than pixels.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "analysis/plot/colour.hpp"
#include "analysis/plot/geometry.hpp"
#include "analysis/plot/stroke.hpp"
#include "analysis/plot/typeface.hpp"

namespace gyrolog {

struct DrawnArea {
    Polyline outline;
    Colour colour;
    double opacity = 1.0;
};

struct DrawnLine {
    Polyline line;
    Stroke stroke;
};

struct DrawnText {
    Typeface typeface;
    std::string text;
    double size_px = 0.0;
    Colour colour;
    Point pen;             // where its baseline begins
    bool upwards = false;  // from there on
};

struct Drawing {
    int width_px = 0;
    int height_px = 0;
    double dpi = 0.0;  // pixels in an inch of paper
    std::vector<std::variant<DrawnArea, DrawnLine, DrawnText>> marks;
};

}  // namespace gyrolog
