// Points, boxes and polylines on the picture, in pixels: x to the right, y downwards, (0, 0) the picture's
// corner.
#pragma once

#include <optional>
#include <vector>

namespace gyrolog {

struct Point {
    double x = 0.0;
    double y = 0.0;
};

struct Box {
    double left = 0.0;
    double top = 0.0;
    double right = 0.0;
    double bottom = 0.0;

    double width() const { return right - left; }
    double height() const { return bottom - top; }
    Point centre() const { return {(left + right) / 2.0, (top + bottom) / 2.0}; }
    Box grown(double by) const { return {left - by, top - by, right + by, bottom + by}; }
    bool contains(Point p) const { return p.x >= left && p.x <= right && p.y >= top && p.y <= bottom; }
    bool contains(const Box& other) const;
    bool overlaps(const Box& other) const;  // touching edges do not overlap
};

using Polyline = std::vector<Point>;

struct LineSegment {
    Point a;
    Point b;
};

// The part of the segment inside the box (Liang and Barsky 1984); nothing when it misses the box or is not
// finite.
std::optional<LineSegment> clip(LineSegment segment, const Box& box);

// The parts of a polyline inside the box, in order. A point that is not finite breaks the line.
std::vector<Polyline> clip(const Polyline& line, const Box& box);

// The part of a closed polygon inside the box (Sutherland and Hodgman 1974). All points must be finite.
Polyline clip_polygon(const Polyline& polygon, const Box& box);

// Cuts a line into its drawn pieces. pattern_px: lengths drawn, left out, drawn, ... repeated; empty: the
// whole line.
std::vector<Polyline> dashed(const Polyline& line, const std::vector<double>& pattern_px);

}  // namespace gyrolog
