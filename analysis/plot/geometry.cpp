#include "analysis/plot/geometry.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace gyrolog {
namespace {

bool is_finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

Point between(Point a, Point b, double share) {
    return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

// Narrows [enter, leave] to where `start + t * step` is at least zero.
bool narrow(double start, double step, double& enter, double& leave) {
    if (step == 0.0) { return start >= 0.0; }
    const double t = -start / step;
    if (step > 0.0) {
        enter = std::fmax(enter, t);
    } else {
        leave = std::fmin(leave, t);
    }
    return enter <= leave;
}

struct Edge {
    double a, b, c;  // inside where a x + b y + c >= 0
    double side(Point p) const { return a * p.x + b * p.y + c; }
};

}  // namespace

bool Box::contains(const Box& other) const {
    return other.left >= left && other.right <= right && other.top >= top && other.bottom <= bottom;
}

bool Box::overlaps(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
}

std::optional<LineSegment> clip(LineSegment segment, const Box& box) {
    const auto [a, b] = segment;
    if (!is_finite(a) || !is_finite(b)) { return std::nullopt; }
    const Point step{b.x - a.x, b.y - a.y};
    if (!is_finite(step)) { return std::nullopt; }
    double enter = 0.0;
    double leave = 1.0;
    const bool meets =
        narrow(a.x - box.left, step.x, enter, leave) && narrow(box.right - a.x, -step.x, enter, leave) &&
        narrow(a.y - box.top, step.y, enter, leave) && narrow(box.bottom - a.y, -step.y, enter, leave);
    if (!meets) { return std::nullopt; }
    return LineSegment{enter > 0.0 ? between(a, b, enter) : a, leave < 1.0 ? between(a, b, leave) : b};
}

std::vector<Polyline> clip(const Polyline& line, const Box& box) {
    std::vector<Polyline> parts;
    bool joins_last = false;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const auto piece = clip(LineSegment{line[i], line[i + 1]}, box);
        if (!piece) {
            joins_last = false;
            continue;
        }
        if (!joins_last) { parts.push_back({piece->a}); }
        parts.back().push_back(piece->b);
        joins_last = box.contains(line[i + 1]);
    }
    return parts;
}

Polyline clip_polygon(const Polyline& polygon, const Box& box) {
    const std::array<Edge, 4> edges{Edge{1.0, 0.0, -box.left}, Edge{-1.0, 0.0, box.right},
                                    Edge{0.0, 1.0, -box.top}, Edge{0.0, -1.0, box.bottom}};
    Polyline inside = polygon;
    for (const Edge& edge : edges) {
        Polyline kept;
        for (std::size_t i = 0; i < inside.size(); ++i) {
            const Point from = inside[i];
            const Point to = inside[(i + 1) % inside.size()];
            const double from_side = edge.side(from);
            const double to_side = edge.side(to);
            if (from_side >= 0.0) { kept.push_back(from); }
            if ((from_side >= 0.0) != (to_side >= 0.0)) {
                kept.push_back(between(from, to, from_side / (from_side - to_side)));
            }
        }
        inside = std::move(kept);
    }
    return inside;
}

std::vector<Polyline> dashed(const Polyline& line, const std::vector<double>& pattern_px) {
    double period_px = 0.0;
    for (const double length_px : pattern_px) { period_px += length_px; }
    if (line.size() < 2 || !(period_px > 0.0)) { return {line}; }

    std::vector<Polyline> pieces;
    std::size_t phase = 0;
    double left_px = pattern_px[0];
    bool pen_down = true;
    pieces.push_back({line[0]});
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double length_px = std::hypot(line[i + 1].x - line[i].x, line[i + 1].y - line[i].y);
        double done_px = 0.0;
        while (length_px - done_px > left_px) {
            done_px += left_px;
            const Point here = between(line[i], line[i + 1], done_px / length_px);
            if (pen_down) {
                pieces.back().push_back(here);
            } else {
                pieces.push_back({here});
            }
            pen_down = !pen_down;
            phase = (phase + 1) % pattern_px.size();
            left_px = pattern_px[phase];
        }
        left_px -= length_px - done_px;
        if (pen_down) { pieces.back().push_back(line[i + 1]); }
    }
    return pieces;
}

}  // namespace gyrolog
