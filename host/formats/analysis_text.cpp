#include "host/formats/analysis_text.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "analysis/numerics/distributions.hpp"
#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/noise_text.hpp"
#include "host/formats/stops_text.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

// A sensor's axes, and the unit of their table.
struct SensorTable {
    const std::vector<AxisReport>& axes;
    SensorUnit unit;
};

// The three strongest lines, where an axis has some and the fit does not name them already; JSON has them
// all.
std::vector<TextRow> line_rows(const SensorTable& sensor) {
    constexpr std::size_t shown = 3;
    std::size_t most = 0;
    for (const AxisReport& axis : sensor.axes) {
        if (axis.fit.sinusoids.empty()) { most = std::max(most, axis.lines.size()); }
    }
    std::vector<TextRow> rows;
    for (std::size_t i = 0; i < std::min(most, shown); ++i) {
        TextRow amplitude{i == 0 ? "spectral lines" : "", sensor.unit.name, {}};
        TextRow frequency{"   at", "Hz", {}};
        for (const AxisReport& axis : sensor.axes) {
            const bool has = axis.fit.sinusoids.empty() && i < axis.lines.size();
            amplitude.cells.push_back(
                has ? fmt::format("{:.3g}", axis.lines[i].amplitude * sensor.unit.per_column_unit) : "-");
            frequency.cells.push_back(has ? fmt::format("{:.5g}", axis.lines[i].f_hz) : "-");
        }
        rows.push_back(std::move(amplitude));
        rows.push_back(std::move(frequency));
    }
    return rows;
}

TextRow mean_row(const SensorTable& sensor) {
    // Micro-g are for noise.
    const bool is_gyro = sensor.unit.sensor == SensorKind::gyro;
    const SensorUnit unit = is_gyro || sensor.unit.is_counts() ? sensor.unit : SensorUnit::g();
    TextRow row{is_gyro ? "bias" : "mean, with gravity", unit.name, {}};
    for (const AxisReport& axis : sensor.axes) {
        row.cells.push_back(in_short_form(axis.bias.value * unit.per_column_unit,
                                          axis.bias.expanded_uncertainty * unit.per_column_unit));
    }
    return row;
}

// Where an axis has one: the interval's end where it is not there beyond chance, as for the noise.
std::vector<TextRow> temperature_rows(const SensorTable& sensor, double confidence) {
    TextRow row{"bias over temperature", sensor.unit.name + "/degC", {}};
    bool any = false;
    for (const AxisReport& axis : sensor.axes) {
        if (!axis.temperature) {
            row.cells.emplace_back("-");
            continue;
        }
        any = true;
        const TemperatureDrift& drift = *axis.temperature;
        const double value = drift.slope_per_C * sensor.unit.per_column_unit;
        const double sd = drift.sd_per_C * sensor.unit.per_column_unit;
        const double upper = std::abs(value) + normal_quantile(0.5 + confidence / 2.0) * sd;
        row.cells.push_back(drift.is_there ? in_short_form(value, sd) : "< " + in_digits(upper, 2));
    }
    return any ? std::vector{row} : std::vector<TextRow>{};
}

std::vector<TextRow> lowest_rows(const SensorTable& sensor) {
    TextRow deviation{"lowest deviation", sensor.unit.name, {}};
    TextRow from{"   from", sensor.unit.name, {}};
    TextRow to{"   to", sensor.unit.name, {}};
    TextRow tau{"   at tau", "s", {}};
    for (const AxisReport& axis : sensor.axes) {
        const AllanPoint* lowest = lowest_point(axis.curve);
        const auto size = [&](double AllanPoint::*of) {
            return lowest == nullptr ? "-" : fmt::format("{:.3g}", lowest->*of * sensor.unit.per_column_unit);
        };
        deviation.cells.push_back(size(&AllanPoint::deviation));
        from.cells.push_back(size(&AllanPoint::lo));
        to.cells.push_back(size(&AllanPoint::hi));
        tau.cells.push_back(lowest == nullptr ? "-" : in_digits(lowest->tau_s, 3));
    }
    return {deviation, from, to, tau};
}

std::vector<TextRow> rows_of(const SensorTable& sensor, std::span<const FitOfColumn> fits,
                             double confidence) {
    std::vector<TextRow> rows = {mean_row(sensor)};
    for (TextRow& row : temperature_rows(sensor, confidence)) { rows.push_back(std::move(row)); }
    for (TextRow& row : noise_rows(fits, sensor.unit)) { rows.push_back(std::move(row)); }
    for (TextRow& row : lowest_rows(sensor)) { rows.push_back(std::move(row)); }
    for (TextRow& row : line_rows(sensor)) { rows.push_back(std::move(row)); }
    return rows;
}

std::string gravity_text(const AccelerometerReport& report) {
    const SensorUnit& unit = report.unit.is_counts() ? report.unit : SensorUnit::g();
    std::string text;
    for (const AccelerometerReport::UnitGravity& of : report.gravity) {
        const auto number = [](const ExpandedNumber& n, double scale) {
            return with_uncertainty(n.value * scale, n.expanded_uncertainty * scale);
        };
        text += fmt::format("  gravity{}: {} {}; {} is up, tilted by {} deg\n",
                            of.unit.empty() ? "" : " of unit " + printable(of.unit),
                            number(of.gravity.size, unit.per_column_unit), unit.name, of.gravity.up_name(),
                            number(of.gravity.tilt_rad, deg_per_rad));
    }
    return text;
}

std::string head_of(const AnalysisReport& report) {
    std::string text = fmt::format("{}: {}, {}", printable(report.name), counted(report.samples, "sample"),
                                   duration_text(report.duration_s));
    text += fmt::format(", {} Hz", report.rate_sd_hz ? with_uncertainty(report.rate_hz, *report.rate_sd_hz)
                                                     : fmt::format("{:.6g}", report.rate_hz));
    if (report.nominal_rate_hz) {
        text += fmt::format(" (nominal {:g} Hz, {:+.0f} ppm)", *report.nominal_rate_hz,
                            (report.rate_hz / *report.nominal_rate_hz - 1.0) * 1e6);
    }
    if (report.stamps == StampKind::none) { text += " as given"; }
    text = wrapped_text("", text);
    if (report.dropouts > 0) {
        text += fmt::format("{}, {} missing; {}\n", counted(report.dropouts, "dropout"),
                            counted(static_cast<std::uint64_t>(report.samples_missing), "sample"),
                            counted(report.segments, "unbroken segment"));
    } else if (report.stamps == StampKind::sampling) {
        text += "no dropouts\n";
    }
    if (report.stops > 0) { text += stops_text(report.stops, report.stopped_s) + "\n"; }
    for (const std::string& warning : report.warnings) { text += wrapped_text("warning: ", warning); }
    return text;
}

// What the signs in a table mean.
std::string signs_text(const AnalysisReport& report, const char* expanded) {
    return fmt::format(
        "  In brackets: one standard deviation in the last two digits ({}: expanded,\n"
        "  95.45 %). \"<\": not identifiable in this record, upper limit at {:.3g} %.\n"
        "  (at best): the Cramer-Rao bound, below which no unbiased method gets.\n"
        "  Lowest deviation: where {:g} degrees of freedom or more stand behind it, with\n"
        "  its interval at {:.3g} %.\n",
        expanded, report.confidence * 100.0, edf_to_read, report.confidence * 100.0);
}

// Empty where the record tells the slow terms of every axis.
std::string limits_text(const std::vector<AxisReport>& axes) {
    const auto is_limit = [&](NoiseTerm term) {
        return std::ranges::any_of(axes, [term](const AxisReport& axis) {
            const FittedCoefficient& fitted = axis.fit[term];
            return fitted.state == FittedCoefficient::State::not_identifiable && fitted.upper > 0.0;
        });
    };
    std::string terms = is_limit(NoiseTerm::B) ? "B (flicker_missing)" : "";
    if (is_limit(NoiseTerm::K)) { terms += (terms.empty() ? "" : " or ") + std::string("K (rrw_missing)"); }
    if (terms.empty()) { return {}; }
    return wrapped_text("  ",
                        "A model has 0 in place of a term below its limit. `diagnose` tests that 0 and may "
                        "find a " +
                            terms + ": a size below the limit does not contradict it.");
}

// One in the trade's units with the text below it, and one in SI.
std::string tables_of(const SensorTable& sensor, double confidence, const std::string& below) {
    std::vector<FitOfColumn> fits;
    std::vector<std::string> heads;
    for (const AxisReport& axis : sensor.axes) {
        fits.push_back({&axis.fit, &axis.slopes});
        heads.push_back(printable(axis.axis));
    }
    std::string text = '\n' + text_table(heads, rows_of(sensor, fits, confidence)) + '\n' + below;
    const std::vector<TextRow> si = si_rows(fits, sensor.unit);
    if (!si.empty()) { text += '\n' + text_table(heads, si); }
    return text;
}

}  // namespace

std::string analysis_text(const AnalysisReport& report) {
    std::string text = head_of(report);
    if (!report.axes.empty()) {
        if (report.accelerometer) { text += "\ngyro\n"; }
        text += tables_of({report.axes, report.unit}, report.confidence,
                          signs_text(report, "bias") + limits_text(report.axes));
    }
    if (report.accelerometer) {
        const AccelerometerReport& of = *report.accelerometer;
        const std::string signs =
            gravity_text(of) + (report.axes.empty() ? signs_text(report, "mean, gravity, tilt") : "") +
            "  Mean, gravity and tilt: expanded, 95.45 %, as far as this record's noise goes;\n"
            "  the axes' own biases and scale factors are in them.\n" +
            limits_text(of.axes);
        text +=
            "\naccelerometer\n" + tables_of({of.axes, of.unit.is_counts() ? of.unit : SensorUnit::micro_g()},
                                            report.confidence, signs);
    }
    return text;
}

}  // namespace gyrolog
