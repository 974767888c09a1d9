// Finding room for a label or a legend where it covers nothing.
#pragma once

#include <optional>
#include <vector>

#include "analysis/plot/geometry.hpp"

namespace gyrolog {

// What has been drawn and must stay visible.
class Obstacles {
public:
    void add(const Polyline& line);          // finite points
    void add_area(const Polyline& polygon);  // finite points, closed
    void add(const Box& box) { boxes_.push_back(box); }

    bool touches(const Box& box) const;

private:
    std::vector<LineSegment> segments_;
    std::vector<Polyline> areas_;
    std::vector<Box> boxes_;
};

struct Size {
    double width_px = 0.0;
    double height_px = 0.0;
};

// The free place nearest to a corner of `room` for a box of that size, kept clear by clear_px on every side:
// the four corners first (right ones, then left ones; top before bottom), then every place of a grid.
std::optional<Box> place_in_corner(Size size, const Box& room, double clear_px, const Obstacles& obstacles);

// The free place beside a point: right, left, above, below and between, nearest first.
std::optional<Box> place_beside(Point anchor, double distance_px, Size size, const Box& room,
                                const Obstacles& obstacles);
// The place to the right of a point on its level, where it is free.
std::optional<Box> place_level(Point anchor, double distance_px, Size size, const Box& room,
                               const Obstacles& obstacles);

}  // namespace gyrolog
