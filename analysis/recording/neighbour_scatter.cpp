#include "analysis/recording/neighbour_scatter.hpp"

#include <cmath>
#include <cstddef>

namespace gyrolog {

double neighbour_scatter(const Column& column, std::span<const Segment> segments) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const Segment& segment : segments) {
        for (std::size_t i = segment.first + 1; i < segment.first + segment.count; ++i) {
            const double step = column.value(i) - column.value(i - 1);
            if (!std::isfinite(step)) { continue; }
            sum += step * step;
            ++count;
        }
    }
    return count == 0 ? 0.0 : std::sqrt(0.5 * sum / static_cast<double>(count));
}

}  // namespace gyrolog
