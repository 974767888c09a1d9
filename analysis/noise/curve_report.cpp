#include "analysis/noise/curve_report.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace gyrolog {
namespace {

constexpr std::array<std::string_view, 3> sensor_prefixes = {"sensor", "measured", "real"};
constexpr std::array<std::string_view, 3> simulation_prefixes = {"simulation", "simulated", "sim"};

// What follows the prefix: "_x" of "sensor_x", "" of "sensor".
std::optional<std::string_view> after_prefix(std::string_view name,
                                             std::span<const std::string_view> prefixes) {
    for (const std::string_view prefix : prefixes) {
        if (!name.starts_with(prefix)) { continue; }
        const std::string_view rest = name.substr(prefix.size());
        if (rest.empty() || rest.front() == '_') { return rest; }
    }
    return std::nullopt;
}

std::vector<NamedCurveGap> gaps_between(const std::vector<PrintedCurveReport>& curves) {
    std::vector<NamedCurveGap> gaps;
    for (const PrintedCurveReport& sensor : curves) {
        const auto of_sensor = after_prefix(sensor.name, sensor_prefixes);
        if (!of_sensor) { continue; }
        for (const PrintedCurveReport& simulation : curves) {
            if (after_prefix(simulation.name, simulation_prefixes) != of_sensor) { continue; }
            if (auto gap = compare_curves(sensor.curve, sensor.fit, simulation.curve, simulation.fit)) {
                gaps.push_back({sensor.name, simulation.name, std::move(*gap)});
            }
        }
    }
    return gaps;
}

// The last octaves of every curve are averages of few intervals: a hump there may be chance.
constexpr double late_part = 5.0;

void warn_of_late_terms(const PrintedCurveReport& curve, std::vector<std::string>& warnings) {
    const double late_s = curve.curve.points.back().tau_s / late_part;
    std::string terms;
    for (const CurveTerm& term : curve.fit.terms) {
        if (term.hump_tau_s() > late_s) {
            terms += (terms.empty() ? "" : ", ") + std::string(name_of(term.kind));
        }
    }
    if (terms.empty()) { return; }
    std::ostringstream text;
    text << curve.name << ": " << terms << " rests on averaging times above " << std::setprecision(3)
         << late_s
         << " s, where a record has few independent averages: it describes this curve, and another record of "
            "the "
            "sensor may not show it";
    warnings.push_back(text.str());
}

}  // namespace

CurveReport analyze_curves(PrintedCurves curves, const CurveFitOptions& options) {
    CurveReport report;
    report.name = std::move(curves.name);
    report.unit = std::move(curves.unit);
    report.options = options;
    report.warnings = std::move(curves.warnings);
    for (PrintedCurve& curve : curves.curves) {
        PrintedCurveReport one;
        one.name = std::move(curve.name);
        one.curve = std::move(curve.curve);
        one.curve.confidence = options.confidence;
        one.fit = fit_curve_model(one.curve, options);
        one.slopes = read_slopes(one.curve);
        warn_of_late_terms(one, report.warnings);
        report.curves.push_back(std::move(one));
    }
    report.gaps = gaps_between(report.curves);
    return report;
}

}  // namespace gyrolog
