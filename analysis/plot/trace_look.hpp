// How each trace of a figure is told from the others.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "analysis/plot/allan_figure.hpp"

namespace gyrolog {

inline const std::vector<double> model_dash_px{14.0, 7.0};

struct TraceLook {
    Colour colour;
    Marker marker = Marker::none;
    double width_px = 2.5;
    bool is_one_of_many = false;  // thin, without band, marker, model or legend row of its own

    Colour model_colour() const { return mixed(colour, colours::ink, 0.45); }
};

// Traces that share a look and a legend row.
struct TraceGroup {
    std::string name;
    std::vector<const AllanTrace*> traces;
};

// One for each trace, in their order.
std::vector<TraceLook> passes_of(const std::vector<AllanTrace>& traces);

// By first appearance; every trace alone unless there are many.
std::vector<TraceGroup> groups_of(const std::vector<AllanTrace>& traces);

}  // namespace gyrolog
