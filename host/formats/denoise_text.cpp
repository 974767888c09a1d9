#include "host/formats/denoise_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/text_table.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t failures_shown = 8;
constexpr std::size_t lines_shown = 3;

std::string filter_text(const RateDesign& rate) {
    if (rate.model == RateModel::free) { return "free rate"; }
    if (rate.model == RateModel::adaptive) {
        return fmt::format("adaptive rate, from {:.3g} Hz when calm to {:.3g} Hz in motion",
                           rate.bandwidth_hz * adaptive_bandwidths.front(), rate.bandwidth_hz);
    }
    return fmt::format("{} of {:.4g} Hz", name_of(rate.model), rate.bandwidth_hz);
}

bool is_adaptive(const DenoisedSignal& signal) {
    return signal.design.method != DenoiseMethod::wavelet && signal.design.rate.model == RateModel::adaptive;
}

std::string response_text(const FilterResponse& response) {
    std::string text =
        fmt::format("lag {:.3g} ms", std::abs(response.lag_s) < 5e-7 ? 0.0 : 1e3 * response.lag_s);
    if (response.half_power_hz > 0.0) {
        text += fmt::format(", half of the power of motion passes at {:.3g} Hz", response.half_power_hz);
    }
    return text;
}

std::string factor_text(double before, double after) {
    return before > 0.0 && after > 0.0 ? fmt::format("1/{:.3g}", before / after) : "";
}

std::string still_table(const DenoiseReport& report, const AxisDenoising& axis) {
    if (axis.unit_variances.empty()) { return ""; }
    const double square = report.per_column_unit * report.per_column_unit;
    const std::size_t units = axis.unit_variances.size();
    const double before = axis.unit_variance();
    const std::vector<std::string> heads{"variance", "of one unit", "promised"};
    std::vector<TextRow> rows;
    const auto row = [&](std::string name, double variance, std::string promised) {
        rows.push_back({"  " + std::move(name),
                        report.unit + "^2",
                        {fmt::format("{:.4g}", variance * square),
                         variance == before ? "" : factor_text(before, variance), std::move(promised)}});
    };
    row(units == 1 ? "the unit" : fmt::format("one of {} units", units), before, "");
    if (units > 1) { row("their plain mean", axis.mean_variance, fmt::format("1/{}", units)); }
    for (const DenoisedSignal& signal : axis.signals) {
        row(std::string(name_of(signal.design.method)), signal.still_variance,
            fmt::format("1/{:.3g}{}", 1.0 / signal.calm.noise_ratio, is_adaptive(signal) ? " at best" : ""));
    }
    return fmt::format("at rest, {:.6g} s to {:.6g} s:\n", report.still.from_s, report.still.to_s) +
           text_table(heads, rows);
}

std::string motion_table(const DenoiseReport& report, const AxisDenoising& axis) {
    if (!axis.unit_motion) { return ""; }
    const double square = report.per_column_unit * report.per_column_unit;
    const std::vector<std::string> heads{"error", "motion", "noise", "lag (ms)", "gain"};
    std::vector<TextRow> rows;
    const auto row = [&](std::string name, const MotionError& error) {
        rows.push_back({"  " + std::move(name),
                        report.unit + "^2",
                        {fmt::format("{:.4g}", error.error_variance * square),
                         fmt::format("{:.4g}", error.motion_variance * square),
                         fmt::format("{:.4g}", error.noise_variance * square),
                         fmt::format("{:.2f}", 1e3 * error.lag_s), fmt::format("{:.4f}", error.gain)}});
    };
    row("first unit", *axis.unit_motion);
    for (const DenoisedSignal& signal : axis.signals) {
        if (signal.motion) { row(std::string(name_of(signal.design.method)), *signal.motion); }
    }
    return wrapped_text("",
                        "against the reference (variance of the error; its part by lag and gain; its part "
                        "by noise):") +
           text_table(heads, rows);
}

std::string bands_table(const AxisDenoising& axis) {
    const std::size_t units = axis.knowledge.units.size();
    if (units < 2 || axis.knowledge.bands.empty()) { return ""; }
    const std::vector<std::string> heads{"correlation", "chance", "plain mean", "best weights",
                                         "any number of units"};
    std::vector<TextRow> rows;
    for (const UnitBand& band : axis.knowledge.bands) {
        const double limit = band.gain_limit();
        rows.push_back({fmt::format("  {:.3g} to {:.3g}", band.from_hz, band.to_hz),
                        "Hz",
                        {fmt::format("{:+.3f}", band.mean_correlation),
                         fmt::format("{:.3f}", band.correlation_sd), fmt::format("1/{:.3g}", band.gain_mean),
                         band.gain_best > 0.0 ? fmt::format("1/{:.3g}", band.gain_best) : "",
                         std::isfinite(limit) ? fmt::format("1/{:.3g} at most", limit) : "not limited"}});
    }
    return wrapped_text("", fmt::format("what the {} units have in common, and what averaging gains in each "
                                        "band:",
                                        units)) +
           text_table(heads, rows);
}

std::string units_table(const DenoiseReport& report, const AxisDenoising& axis) {
    const std::size_t units = axis.knowledge.units.size();
    if (units < 2) { return ""; }
    const std::vector<std::string> heads{"white noise", "drift", "weight", "in drift",
                                         "lines (of its variance)"};
    std::vector<TextRow> rows;
    for (std::size_t i = 0; i < units; ++i) {
        const UnitKnowledge& unit = axis.knowledge.units[i];
        const UnitNoise& noise = axis.knowledge.noise.units[i];
        std::string lines;
        for (std::size_t k = 0; k < std::min(lines_shown, unit.lines.size()); ++k) {
            const SpectralLine& line = unit.lines[k];
            lines += fmt::format(
                "{}{:.3g} Hz ({:.0f} %)", k == 0 ? "" : ", ", line.f_hz,
                unit.variance > 0.0 ? 50.0 * line.amplitude * line.amplitude / unit.variance : 0.0);
        }
        rows.push_back({"  unit " + unit.name,
                        report.unit,
                        {fmt::format("{:.3g}", std::sqrt(noise.white_variance) * report.per_column_unit),
                         fmt::format("{:.3g}", std::sqrt(noise.walk_variance * axis.knowledge.noise.rate_hz) *
                                                   report.per_column_unit),
                         fmt::format("{:.3f}", axis.sample_weights[i]),
                         fmt::format("{:.3f}", axis.drift_weights[i]), lines}});
    }
    return fmt::format("units (white noise of a sample; drift in {}*sqrt(Hz)):\n", report.unit) +
           text_table(heads, rows);
}

std::string failures_text(const AxisDenoising& axis) {
    std::string text;
    for (std::size_t i = 0; i < std::min(failures_shown, axis.failures.size()); ++i) {
        const UnitFailure& failure = axis.failures[i];
        text += wrapped_text(
            "  ", fmt::format("unit{} {}{} from {:.6g} s to {:.6g} s, {} samples",
                              failure.unit.empty() ? "" : " " + failure.unit, name_of(failure.state),
                              axis.knowledge.units.size() > 1 ? ", left out" : "", failure.from_s,
                              failure.to_s, failure.samples));
    }
    const std::size_t more =
        axis.failures.size() + axis.failures_more - std::min(failures_shown, axis.failures.size());
    if (more > 0) { text += fmt::format("  and {} more times\n", more); }
    return text.empty() ? text : "units left out, and why:\n" + text;
}

}  // namespace

std::string design_text(const DenoiseDesign& design) {
    switch (design.method) {
        case DenoiseMethod::kalman:
            return "kalman: " + filter_text(design.rate);
        case DenoiseMethod::wavelet:
            return fmt::format("wavelet: db4, {} levels, {} samples", design.levels, design.window);
        case DenoiseMethod::joint:
            break;
    }
    return fmt::format("joint: {}, then wavelet (db4, {} levels, {} samples)", filter_text(design.rate),
                       design.levels, design.window);
}

std::string denoise_text(const DenoiseReport& report) {
    std::string text =
        wrapped_text("", fmt::format("{}: {:.6g} Hz, {}, {}", printable(report.name), report.rate_hz,
                                     duration_text(report.duration_s), counted(report.samples, "sample")));
    for (const std::string& warning : report.warnings) { text += wrapped_text("warning: ", warning); }
    text += wrapped_text("noise of the units: ", report.learned_from);
    if (report.axes.empty()) { return text; }
    for (const DenoisedSignal& signal : report.axes.front().signals) {
        text += wrapped_text("", design_text(signal.design) + "; " + response_text(signal.response));
    }
    for (const AxisDenoising& axis : report.axes) {
        text += fmt::format("\n{}\n", axis.knowledge.axis);
        text += still_table(report, axis) + motion_table(report, axis) + units_table(report, axis) +
                bands_table(axis) + failures_text(axis);
    }
    return text;
}

}  // namespace gyrolog
