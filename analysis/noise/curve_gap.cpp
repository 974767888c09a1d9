#include "analysis/noise/curve_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gyrolog {
namespace {

using Verdict = CurveGapTerm::Verdict;

struct GapPoint {
    double tau_s;
    double gap_db;
};

std::vector<AllanPoint> usable_points(const AllanCurve& curve) {
    std::vector<AllanPoint> points;
    std::ranges::copy_if(curve.points, std::back_inserter(points),
                         [](const AllanPoint& p) { return p.deviation > 0.0 && p.tau_s > 0.0; });
    std::ranges::stable_sort(points, {}, &AllanPoint::tau_s);
    return points;
}

// Averaging times read off one axis twice differ in their last digit.
constexpr double same_tau = 1e-3;

std::optional<double> deviation_at(const std::vector<AllanPoint>& points, double tau_s) {
    const auto right = std::ranges::lower_bound(points, tau_s * (1.0 - same_tau), {}, &AllanPoint::tau_s);
    if (right == points.end()) { return std::nullopt; }
    if (right->tau_s <= tau_s * (1.0 + same_tau)) { return right->deviation; }
    if (right == points.begin()) { return std::nullopt; }
    const AllanPoint& left = *(right - 1);
    const double part = std::log(tau_s / left.tau_s) / std::log(right->tau_s / left.tau_s);
    return left.deviation * std::pow(right->deviation / left.deviation, part);
}

std::vector<GapPoint> gap_points(const AllanCurve& sensor, const AllanCurve& simulation) {
    const std::vector<AllanPoint> reference = usable_points(simulation);
    std::vector<GapPoint> points;
    for (const AllanPoint& point : usable_points(sensor)) {
        if (const auto deviation = deviation_at(reference, point.tau_s)) {
            points.push_back({point.tau_s, 20.0 * std::log10(point.deviation / *deviation)});
        }
    }
    return points;
}

CurveResidual residual_of(const std::vector<GapPoint>& points) {
    CurveResidual residual;
    double sum = 0.0;
    for (const GapPoint& point : points) {
        sum += point.gap_db * point.gap_db;
        if (std::abs(point.gap_db) > std::abs(residual.worst_db)) {
            residual.worst_db = point.gap_db;
            residual.worst_tau_s = point.tau_s;
        }
    }
    residual.rms_db = std::sqrt(sum / static_cast<double>(points.size()));
    return residual;
}

bool is_paired(CurveTerm::Kind kind) {
    return kind != CurveTerm::Kind::gauss_markov && kind != CurveTerm::Kind::sinusoid;
}

// Gauss-Markov noises or sinusoids are the same one where their correlation times or frequencies are within a
// factor of two.
bool is_same(const CurveTerm& a, const CurveTerm& b) {
    return a.kind == b.kind && (is_paired(a.kind) || std::abs(std::log2(a.shape / b.shape)) < 1.0);
}

Verdict verdict_of(const CurveGapTerm& term) {
    if (!term.simulation) { return Verdict::lacking; }
    if (!term.sensor) { return Verdict::extra; }
    const double ratio_db = 20.0 * std::log10(term.sensor->size / term.simulation->size);
    if (std::abs(ratio_db) < curve_gap_floor_db) { return Verdict::agrees; }
    return ratio_db > 0.0 ? Verdict::too_weak : Verdict::too_strong;
}

std::vector<CurveGapTerm> paired_terms(const std::vector<CurveTerm>& sensor,
                                       std::vector<CurveTerm> simulation) {
    std::vector<CurveGapTerm> terms;
    for (const CurveTerm& term : sensor) {
        CurveGapTerm pair{term.kind, term, std::nullopt, Verdict::agrees};
        const auto match =
            std::ranges::find_if(simulation, [&](const CurveTerm& t) { return is_same(t, term); });
        if (match != simulation.end()) {
            pair.simulation = *match;
            simulation.erase(match);
        }
        pair.verdict = verdict_of(pair);
        terms.push_back(pair);
    }
    for (const CurveTerm& term : simulation) {
        terms.push_back({term.kind, std::nullopt, term, Verdict::extra});
    }
    return terms;
}

void attribute(CurveGapStretch& stretch, const std::vector<CurveGapTerm>& terms) {
    double sum = 0.0;
    double most = 0.0;
    for (const CurveGapTerm& term : terms) {
        const double in_sensor = term.sensor ? term.sensor->allan_variance(stretch.worst_tau_s) : 0.0;
        const double in_simulation =
            term.simulation ? term.simulation->allan_variance(stretch.worst_tau_s) : 0.0;
        const double along = std::copysign(1.0, stretch.worst_db) * (in_sensor - in_simulation);
        if (along <= 0.0) { continue; }
        sum += along;
        if (along > most) {
            most = along;
            stretch.term = term.kind;
        }
    }
    if (sum > 0.0) { stretch.share = most / sum; }
}

std::vector<CurveGapStretch> stretches_of(const std::vector<GapPoint>& points,
                                          const std::vector<CurveGapTerm>& terms) {
    std::vector<CurveGapStretch> stretches;
    bool open = false;
    for (const GapPoint& point : points) {
        const bool parted = std::abs(point.gap_db) > curve_gap_floor_db;
        open = open && parted && std::signbit(point.gap_db) == std::signbit(stretches.back().worst_db);
        if (!parted) { continue; }
        if (!open) { stretches.push_back({point.tau_s, point.tau_s, 0.0, point.tau_s, std::nullopt, 0.0}); }
        open = true;
        CurveGapStretch& stretch = stretches.back();
        stretch.to_tau_s = point.tau_s;
        if (std::abs(point.gap_db) > std::abs(stretch.worst_db)) {
            stretch.worst_db = point.gap_db;
            stretch.worst_tau_s = point.tau_s;
        }
    }
    for (CurveGapStretch& stretch : stretches) { attribute(stretch, terms); }
    return stretches;
}

}  // namespace

std::string_view name_of(CurveGapTerm::Verdict verdict) {
    constexpr std::array<std::string_view, 5> names = {"agrees", "lacking", "too_weak", "too_strong",
                                                       "extra"};
    return names[static_cast<std::size_t>(verdict)];
}

std::optional<CurveGap> compare_curves(const AllanCurve& sensor, const CurveModelFit& sensor_fit,
                                       const AllanCurve& simulation, const CurveModelFit& simulation_fit) {
    const std::vector<GapPoint> points = gap_points(sensor, simulation);
    if (points.empty()) { return std::nullopt; }
    CurveGap gap;
    gap.points = points.size();
    gap.residual = residual_of(points);
    gap.terms = paired_terms(sensor_fit.terms, simulation_fit.terms);
    gap.stretches = stretches_of(points, gap.terms);
    return gap;
}

}  // namespace gyrolog
