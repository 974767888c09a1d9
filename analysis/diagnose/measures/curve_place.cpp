#include "analysis/diagnose/measures/curve_place.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/decision_options.hpp"

namespace gyrolog {

std::optional<Span> span_outside(const GapCurve& curve, const std::vector<double>& z) {
    std::optional<Span> span;
    double worst = 0.0;
    for (const double value : z) { worst = std::max(worst, std::fabs(value)); }
    // Where nothing is seen, what is nearly as far off as the worst point.
    const double limit = std::min(decisions.seen_sigma, 0.7 * worst);
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

void locate_averaging_times(const GapCurve& curve, const std::vector<double>& z, Place& where) {
    where.tau_s = span_outside(curve, z);
}

void locate_frequencies(const GapCurve& curve, const std::vector<double>& z, Place& where) {
    where.freq_hz = span_outside(curve, z);
}

void locate_times(const GapCurve& curve, const std::vector<double>& z, Place& where) {
    where.time_s = span_outside(curve, z);
}

void locate_rates(const GapCurve& curve, const std::vector<double>& z, Place& where) {
    where.rate_rad_s = span_outside(curve, z);
}

void locate_period(const GapCurve& curve, const std::vector<double>& z, Place& where) {
    where.tau_s = worst_point(curve, z);
}

}  // namespace gyrolog
