// How lines and points look. Sizes are for a figure of scale 1.
#pragma once

#include <vector>

#include "analysis/plot/colour.hpp"

namespace gyrolog {

enum class Marker { none, circle, square, triangle, diamond, triangle_down, hexagon };

struct Stroke {
    Colour colour = colours::ink;
    double width_px = 2.0;        // 0: no line
    std::vector<double> dash_px;  // drawn, left out, ...; empty: solid

    Stroke scaled(double by) const {
        Stroke bigger = *this;
        bigger.width_px *= by;
        for (double& length_px : bigger.dash_px) { length_px *= by; }
        return bigger;
    }
};

}  // namespace gyrolog
