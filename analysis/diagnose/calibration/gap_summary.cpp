#include "analysis/diagnose/calibration/gap_summary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gyrolog {

GapSummary summarise(const std::vector<GapCurve>& curves, const GapReference& reference) {
    GapSummary summary;
    const std::vector<double> surprises = surprises_nats(curves, reference);
    std::vector<CurveDistance> gaps;
    std::size_t worst = 0;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        gaps.push_back(gap_of(curves[c], reference, c));
        const auto rank = [&](std::size_t i) { return std::pair(surprises[i], gaps[i].surprise_nats); };
        if (rank(c) > rank(worst)) { worst = c; }
    }
    const double value = gaps[worst].distance;
    const auto points = static_cast<double>(std::max<std::size_t>(gaps[worst].z.size(), 1));
    // Of a noncentral chi-square with as many degrees of freedom as points, its root.
    const double sd = std::sqrt((2.0 * value * value - 1.0 > 0.0 ? 2.0 * value * value - 1.0 : 1.0) /
                                (2.0 * points * value * value + 1e-12));
    summary.gap = {value, 1.0, std::max(0.0, value - 1.96 * sd), value + 1.96 * sd};
    for (std::size_t c = 0; c < curves.size(); ++c) {
        if (curves[worst].of_all_axes) { summary.where.axes.push_back(curves[c].axis); }
        if (curves[c].measure != curves[worst].measure || surprises[c] < stands_out_nats) { continue; }
        if (curves[c].of_all_axes) { continue; }
        summary.where.axes.push_back(curves[c].axis);
    }
    if (summary.where.axes.empty()) { summary.where.axes.push_back(curves[worst].axis); }
    std::vector<std::size_t>& axes = summary.where.axes;
    std::ranges::sort(axes);
    axes.erase(std::unique(axes.begin(), axes.end()), axes.end());
    curves[worst].measure->locate(curves[worst], gaps[worst].z, summary.where);
    return summary;
}

}  // namespace gyrolog
