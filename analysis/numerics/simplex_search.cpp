#include "analysis/numerics/simplex_search.hpp"

#include <algorithm>

namespace gyrolog {

namespace {

using Point = SimplexMaximum;

std::vector<double> along(const std::vector<double>& from, const std::vector<double>& to, double share) {
    std::vector<double> point(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) { point[i] = from[i] + share * (to[i] - from[i]); }
    return point;
}

}  // namespace

SimplexMaximum simplex_maximum(const std::function<double(const std::vector<double>&)>& function,
                               const std::vector<double>& start, double step, double tolerance, int most) {
    int evaluations = 0;
    const auto evaluated = [&](std::vector<double> at) {
        ++evaluations;
        const double value = function(at);
        return Point{std::move(at), value};
    };
    std::vector<Point> corners = {evaluated(start)};
    for (std::size_t i = 0; i < start.size(); ++i) {
        std::vector<double> moved = start;
        moved[i] += step;
        corners.push_back(evaluated(std::move(moved)));
    }
    const auto better = [](const Point& a, const Point& b) { return a.value > b.value; };
    while (true) {
        std::ranges::sort(corners, better);
        Point& worst = corners.back();
        if (corners.front().value - worst.value < tolerance || evaluations >= most) {
            return corners.front();
        }
        std::vector<double> middle(start.size(), 0.0);
        for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
            for (std::size_t i = 0; i < middle.size(); ++i) {
                middle[i] += corners[c].at[i] / static_cast<double>(corners.size() - 1);
            }
        }
        Point next = evaluated(along(middle, worst.at, -1.0));
        if (next.value > corners.front().value) {
            Point expanded = evaluated(along(middle, worst.at, -2.0));
            if (expanded.value > next.value) { next = std::move(expanded); }
        } else if (next.value <= corners[corners.size() - 2].value) {
            const bool outside = next.value > worst.value;
            Point contracted = evaluated(along(middle, worst.at, outside ? -0.5 : 0.5));
            if (contracted.value <= std::max(worst.value, next.value)) {
                for (std::size_t c = 1; c < corners.size(); ++c) {
                    corners[c] = evaluated(along(corners.front().at, corners[c].at, 0.5));
                }
                continue;
            }
            next = std::move(contracted);
        }
        worst = std::move(next);
    }
}

}  // namespace gyrolog
