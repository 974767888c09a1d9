#include "analysis/noise/slope_reading.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace gyrolog {
namespace {

// Slopes are read over windows of a factor four in tau: between neighbouring points the curve's own noise is
// steeper than any slope looked for. A window needs edf_to_read at its worst point.
constexpr double half_window = 2.0;

// In logarithms of tau and deviation.
struct Window {
    double centre = 0.0;
    double level = 0.0;
    double slope = 0.0;
    double slope_variance = 0.0;
};

std::optional<Window> window_around(std::span<const AllanPoint> points, double tau_s) {
    double weight = 0.0;
    double x_sum = 0.0;
    double y_sum = 0.0;
    double least_edf = 0.0;
    std::vector<const AllanPoint*> inside;
    for (const AllanPoint& p : points) {
        if (p.tau_s < tau_s / half_window || p.tau_s > tau_s * half_window || p.deviation <= 0.0) {
            continue;
        }
        if (p.edf > 0.0 && p.edf < edf_to_read) { return std::nullopt; }
        least_edf = inside.empty() ? p.edf : std::min(least_edf, p.edf);
        inside.push_back(&p);
    }
    const auto weight_of = [](const AllanPoint& p) { return p.edf > 0.0 ? p.edf : 1.0; };
    for (const AllanPoint* p : inside) {
        weight += weight_of(*p);
        x_sum += weight_of(*p) * std::log(p->tau_s);
        y_sum += weight_of(*p) * std::log(p->deviation);
    }
    if (inside.size() < 3 || inside.back()->tau_s < 1.99 * inside.front()->tau_s) { return std::nullopt; }
    Window window{x_sum / weight, y_sum / weight, 0.0, 0.0};
    double xx = 0.0;
    double xy = 0.0;
    for (const AllanPoint* p : inside) {
        const double x = std::log(p->tau_s) - window.centre;
        xx += weight_of(*p) * x * x;
        xy += weight_of(*p) * x * (std::log(p->deviation) - window.level);
    }
    window.slope = xy / xx;
    if (least_edf > 0.0) {
        // Two ends, each known to 1 / sqrt(2 edf), over the window's length.
        const double length = std::log(inside.back()->tau_s / inside.front()->tau_s);
        window.slope_variance = 1.0 / (least_edf * length * length);
    }
    return window;
}

// The window whose slope is, in the mean square, nearest to the one wanted.
std::optional<Window> window_of_slope(std::span<const Window> windows, double slope, double tolerance) {
    std::optional<Window> best;
    double least = 0.0;
    for (const Window& window : windows) {
        const double off = window.slope - slope;
        if (std::abs(off) > tolerance) { continue; }
        const double square = off * off + window.slope_variance;
        if (!best || square < least) {
            best = window;
            least = square;
        }
    }
    return best;
}

}  // namespace

SlopeReading read_slopes(const AllanCurve& curve) {
    std::vector<Window> windows;
    for (const AllanPoint& point : curve.points) {
        if (const auto window = window_around(curve.points, point.tau_s)) { windows.push_back(*window); }
    }
    SlopeReading reading;
    if (const auto w = window_of_slope(windows, -0.5, 0.1)) {
        reading.N = {std::exp(w->level + 0.5 * w->centre), std::exp(w->centre)};
    }
    if (const auto w = window_of_slope(windows, 0.0, 0.1)) {
        reading.B = {std::exp(w->level) / std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi),
                     std::exp(w->centre)};
    }
    if (const auto w = window_of_slope(windows, 0.5, 0.15)) {
        reading.K = {std::exp(w->level - 0.5 * (w->centre - std::log(3.0))), std::exp(w->centre)};
    }
    return reading;
}

const AllanPoint* lowest_point(const AllanCurve& curve) {
    const AllanPoint* lowest = nullptr;
    for (const AllanPoint& point : curve.points) {
        if (point.edf < edf_to_read) { continue; }
        if (lowest == nullptr || point.deviation < lowest->deviation) { lowest = &point; }
    }
    return lowest;
}

}  // namespace gyrolog
