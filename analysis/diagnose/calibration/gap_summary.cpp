#include "analysis/diagnose/calibration/gap_summary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gyrolog {

namespace {

// Points further off than this many standard deviations are where the gap is.
constexpr double outside_sigma = 3.0;

std::optional<Span> outside(const GapCurve& curve, const std::vector<double>& z) {
    std::optional<Span> span;
    double worst = 0.0;
    for (const double value : z) { worst = std::max(worst, std::fabs(value)); }
    const double limit = std::min(outside_sigma, 0.7 * worst);
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (std::fabs(z[i]) < limit) { continue; }
        if (!span) { span = Span{curve.x[i], curve.x[i]}; }
        span->from = std::min(span->from, curve.x[i]);
        span->to = std::max(span->to, curve.x[i]);
    }
    return span;
}

Span worst_point(const GapCurve& curve, const std::vector<double>& z) {
    const auto worst =
        std::ranges::max_element(z, {}, [](double value) { return std::fabs(value); }) - z.begin();
    const double x = curve.x[static_cast<std::size_t>(worst)];
    return {x, x};
}

void place(const GapCurve& curve, const std::vector<double>& z, Place& where) {
    const std::optional<Span> span = outside(curve, z);
    switch (curve.kind) {
        case GapDomainKind::allan:
        case GapDomainKind::memory:
            where.tau_s = span;
            break;
        case GapDomainKind::rhythm:
        case GapDomainKind::period:
            // Multiples and parts of a period stand out with it.
            where.tau_s = worst_point(curve, z);
            break;
        case GapDomainKind::narrow:
        case GapDomainKind::spectrum:
            where.freq_hz = span;
            break;
        case GapDomainKind::course:
        case GapDomainKind::drift:
        case GapDomainKind::gain_course:
        case GapDomainKind::delay_course:
            where.time_s = span;
            break;
        case GapDomainKind::amplitude:
            where.amplitude_sigma = span;
            break;
        case GapDomainKind::temperature:
            where.temperature = true;
            break;
        case GapDomainKind::cross_axis:
            where.structure = "cross_axis";
            where.freq_hz = span;
            break;
        case GapDomainKind::repeats:
            where.structure = "duplicated_samples";
            break;
        case GapDomainKind::codes:
            where.structure = "code_grid";
            break;
        case GapDomainKind::rate_noise:
        case GapDomainKind::rate:
            where.rate_rad_s = span;
            break;
        case GapDomainKind::acceleration:
            where.acceleration = true;
            break;
    }
}

}  // namespace

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
        if (curves[c].kind != curves[worst].kind || surprises[c] < stands_out_nats) { continue; }
        if (curves[c].of_all_axes) { continue; }
        summary.where.axes.push_back(curves[c].axis);
    }
    if (summary.where.axes.empty()) { summary.where.axes.push_back(curves[worst].axis); }
    std::vector<std::size_t>& axes = summary.where.axes;
    std::ranges::sort(axes);
    axes.erase(std::unique(axes.begin(), axes.end()), axes.end());
    place(curves[worst], gaps[worst].z, summary.where);
    return summary;
}

}  // namespace gyrolog
