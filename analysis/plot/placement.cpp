#include "analysis/plot/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace gyrolog {
namespace {

constexpr int grid_steps = 24;

// Crossing number: whether a ray to the right of the point meets the outline an odd number of times.
bool is_inside(Point p, const Polyline& polygon) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point a = polygon[i];
        const Point b = polygon[(i + 1) % polygon.size()];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) {
            inside = !inside;
        }
    }
    return inside;
}

struct Candidate {
    Box box;
    double cost_px;
};

}  // namespace

void Obstacles::add(const Polyline& line) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) { segments_.push_back({line[i], line[i + 1]}); }
    if (line.size() == 1) { segments_.push_back({line[0], line[0]}); }
}

void Obstacles::add_area(const Polyline& polygon) {
    if (polygon.empty()) { return; }
    add(polygon);
    segments_.push_back({polygon.back(), polygon.front()});
    areas_.push_back(polygon);
}

bool Obstacles::touches(const Box& box) const {
    const auto covers_segment = [&](const LineSegment& segment) { return clip(segment, box).has_value(); };
    const auto covers_box = [&](const Box& other) { return box.overlaps(other); };
    // An outline that does not cross the box leaves it all inside or all outside: its centre tells which.
    const auto lies_in = [&](const Polyline& area) { return is_inside(box.centre(), area); };
    return std::any_of(boxes_.begin(), boxes_.end(), covers_box) ||
           std::any_of(segments_.begin(), segments_.end(), covers_segment) ||
           std::any_of(areas_.begin(), areas_.end(), lies_in);
}

std::optional<Box> place_in_corner(Size size, const Box& room, double clear_px, const Obstacles& obstacles) {
    const Box inner = room.grown(-clear_px);
    const double slack_x = inner.width() - size.width_px;
    const double slack_y = inner.height() - size.height_px;
    if (!(slack_x >= 0.0 && slack_y >= 0.0)) { return std::nullopt; }

    std::vector<Candidate> candidates;
    for (int i = 0; i <= grid_steps; ++i) {
        for (int j = 0; j <= grid_steps; ++j) {
            const double from_left = slack_x * i / grid_steps;
            const double from_top = slack_y * j / grid_steps;
            const double left = inner.left + from_left;
            const double top = inner.top + from_top;
            const double to_side = std::min(from_left + 0.2, slack_x - from_left);
            const double to_end = std::min(from_top, slack_y - from_top + 0.1);
            candidates.push_back({{left, top, left + size.width_px, top + size.height_px}, to_side + to_end});
        }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.cost_px < b.cost_px; });
    const auto free = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
        return !obstacles.touches(candidate.box.grown(clear_px));
    });
    return free == candidates.end() ? std::nullopt : std::optional(free->box);
}

std::optional<Box> place_beside(Point anchor, double distance_px, Size size, const Box& room,
                                const Obstacles& obstacles) {
    struct Direction {
        double x, y;
    };
    constexpr std::array<Direction, 8> directions{Direction{1, -1}, {-1, -1}, {1, 1}, {-1, 1},
                                                  {0, -1},          {0, 1},   {1, 0}, {-1, 0}};
    for (const double reach : {1.0, 2.0, 3.0}) {
        for (const Direction& direction : directions) {
            const double along =
                distance_px * reach * (direction.x != 0.0 && direction.y != 0.0 ? 0.7071 : 1.0);
            const double x = anchor.x + direction.x * (along + size.width_px / 2.0);
            const double y = anchor.y + direction.y * (along + size.height_px / 2.0);
            const Box box{x - size.width_px / 2.0, y - size.height_px / 2.0, x + size.width_px / 2.0,
                          y + size.height_px / 2.0};
            if (room.contains(box) && !obstacles.touches(box)) { return box; }
        }
    }
    return std::nullopt;
}

std::optional<Box> place_level(Point anchor, double distance_px, Size size, const Box& room,
                               const Obstacles& obstacles) {
    const double left = anchor.x + distance_px;
    const double top = anchor.y - size.height_px / 2.0;
    const Box box{left, top, left + size.width_px, top + size.height_px};
    return room.contains(box) && !obstacles.touches(box) ? std::optional(box) : std::nullopt;
}

}  // namespace gyrolog
