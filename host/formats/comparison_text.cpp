#include "host/formats/comparison_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/text_table.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t ranges_listed = 6;

std::string frequency_text(double f_hz) {
    if (f_hz < 0.1) { return fmt::format("{:.3g} mHz", f_hz * 1e3); }
    return f_hz < 1000.0 ? fmt::format("{:.3g} Hz", f_hz) : fmt::format("{:.3g} kHz", f_hz / 1000.0);
}

using PlaceText = std::string (*)(double);

// What the other side is in fault of, or how the recording differs.
std::string difference_text(const Comparison& comparison, double recording_over_other_dB) {
    const double size_dB = std::fabs(recording_over_other_dB);
    const bool noisier = recording_over_other_dB > 0.0;
    if (comparison.simulations > 0) {
        return fmt::format("too {} by {:.2g} dB", noisier ? "quiet" : "noisy", size_dB);
    }
    return fmt::format("{} by {:.2g} dB", noisier ? "noisier" : "quieter", size_dB);
}

std::string range_text(const Comparison& comparison, const OutsideRange& range, PlaceText place) {
    const std::string difference = difference_text(comparison, range.worst_dB);
    if (range.points == 1) { return fmt::format("    at {}: {}\n", place(range.from), difference); }
    return fmt::format("    {} to {}: {} at worst, at {} ({} points)\n", place(range.from), place(range.to),
                       difference, place(range.worst_at), range.points);
}

// The widest in dB, in order of their place.
std::string ranges_text(const Comparison& comparison, const ComparedCurve& curve, PlaceText place) {
    std::vector<OutsideRange> listed = curve.outside;
    std::ranges::stable_sort(listed, std::ranges::greater(),
                             [](const OutsideRange& range) { return std::fabs(range.worst_dB); });
    listed.resize(std::min(listed.size(), ranges_listed));
    std::ranges::sort(listed, {}, &OutsideRange::from);
    std::string text;
    for (const OutsideRange& range : listed) { text += range_text(comparison, range, place); }
    if (listed.size() < curve.outside.size()) {
        text += fmt::format("    and {} smaller ones\n", curve.outside.size() - listed.size());
    }
    return text;
}

TextRow count_row(const Comparison& comparison, const char* name, const ComparedCurve& curve) {
    if (curve.at.empty()) { return {name, "", {"no values above zero", "", ""}}; }
    TextRow row{name,
                "",
                {fmt::format("{} of {}", curve.points_outside(), curve.at.size()),
                 fmt::format("{:.1f}", curve.points_by_chance), ""}};
    if (curve.simulations_outside_as_often && curve.points_outside() > 0) {
        row.cells.back() =
            fmt::format("{} of {}", *curve.simulations_outside_as_often, comparison.simulations);
    }
    return row;
}

// How many points are outside, and where; where chance does as much, places are noise and not listed.
std::string curves_text(const Comparison& comparison, const AxisComparison& axis) {
    const std::array<std::string, 3> heads{"points outside", "by chance",
                                           comparison.simulations > 0 ? "simulations with as many" : ""};
    const std::array rows{count_row(comparison, "Allan deviation", axis.allan),
                          count_row(comparison, "spectrum", axis.spectrum)};
    std::string text = text_table(heads, rows);
    if (axis.allan.gap.stands_out) {
        text += "  Allan deviation\n" + ranges_text(comparison, axis.allan, &duration_text);
    }
    if (axis.spectrum.gap.stands_out) {
        text += "  spectrum\n" + ranges_text(comparison, axis.spectrum, &frequency_text);
    }
    return text;
}

TextRow number_row(const char* label, const char* unit, const ComparedNumber& number, double per_unit) {
    TextRow row{
        label,
        unit,
        {fmt::format("{:.4g}", number.recording * per_unit), fmt::format("{:.4g}", number.other * per_unit)}};
    if (number.lo) {
        row.cells.push_back(fmt::format("{:.3g} to {:.3g}", *number.lo * per_unit, *number.hi * per_unit));
        const char* where = number.outside() ? "outside" : "";
        row.cells.emplace_back(number.stands_out ? "stands out" : where);
    }
    return row;
}

std::string distribution_text(const Comparison& comparison, const AxisComparison& axis) {
    std::vector<std::string> heads{"recording"};
    if (comparison.simulations > 0) {
        heads.insert(heads.end(), {"simulations", "band", ""});
    } else {
        heads.emplace_back("other");
    }
    const std::array rows{number_row("std. deviation", comparison.unit.name.c_str(), axis.standard_deviation,
                                     comparison.unit.per_column_unit),
                          number_row("skewness", "", axis.skewness, 1.0),
                          number_row("excess kurtosis", "", axis.excess_kurtosis, 1.0)};
    return text_table(heads, rows);
}

// "the samples' excess kurtosis is 61, of simulations -0.016 to 0.019"
std::string worst_number_text(const SensorUnit& unit, const AxisComparison& axis,
                              const ComparedNumber& number) {
    const bool is_rate = &number == &axis.standard_deviation;
    const char* shape = &number == &axis.skewness ? "skewness" : "excess kurtosis";
    const double per_unit = is_rate ? unit.per_column_unit : 1.0;
    return fmt::format("the samples' {} is {:.3g}{unit}, of simulations {:.2g} to {:.2g}{unit}",
                       is_rate ? "standard deviation" : shape, number.recording * per_unit,
                       number.lo.value_or(number.other) * per_unit,
                       number.hi.value_or(number.other) * per_unit,
                       fmt::arg("unit", is_rate ? " " + unit.name : std::string()));
}

std::string other_text(const Comparison& comparison) {
    if (comparison.simulations == 0) {
        return printable(comparison.other_name) + ", " + duration_text(comparison.other_duration_s);
    }
    return fmt::format("{} simulations of {} (seed {})", comparison.simulations,
                       printable(comparison.other_name), comparison.seed);
}

// What the numbers below it mean.
std::string explanation_text(const Comparison& comparison) {
    std::string text;
    if (comparison.simulations > 0) {
        const std::size_t rank = band_rank(comparison.simulations);
        text = fmt::format(
            "band: from the {} to the {} of the simulations at each point; one more simulation lies "
            "within it with probability {:.2f} % at each point. Neighbouring points vary together.",
            rank == 1 ? "smallest" : fmt::format("{}. smallest", rank),
            rank == 1 ? "largest" : fmt::format("{}. largest", rank), comparison.band_probability * 100.0);
    } else {
        text = "outside: the 68.3 % intervals of the two do not meet";
    }
    text = wrapped_text("", text);
    if (comparison.unit.sensor == SensorKind::accelerometer) { text += "of the accelerometer\n"; }
    if (comparison.less_reference) { text += "curves are of the gyro less the reference rate\n"; }
    return text;
}

// ", 0.0212 dps where simulations have 0.0123": the larger gap's amplitudes.
std::string amplitudes_text(const Comparison& comparison, const AxisComparison& axis,
                            const ComparedCurve& curve) {
    const auto point = std::ranges::find(curve.at, curve.gap.at);
    if (point == curve.at.end()) { return {}; }
    const auto i = static_cast<std::size_t>(point - curve.at.begin());
    const double per_unit = comparison.unit.per_column_unit;
    return fmt::format(" ({} {:.3g}, {} {:.3g} {}{})",
                       &curve == &axis.allan ? "Allan deviation" : "noise density",
                       curve.recording[i] * per_unit, comparison.simulations > 0 ? "simulated" : "the other",
                       curve.other[i] * per_unit, comparison.unit.name, &curve == &axis.allan ? "" : "/√Hz");
}

bool differs(const AxisComparison& axis) { return axis.worst() != nullptr || axis.worst_number() != nullptr; }

// The sentence without the axis before it.
std::string outcome(const Comparison& comparison, const AxisComparison& axis) {
    std::string curve;
    if (const ComparedCurve* worst = axis.worst()) {
        const PlaceText place = worst == &axis.allan ? &duration_text : &frequency_text;
        curve = fmt::format("{} is {} at {}{}",
                            comparison.simulations > 0 ? "the simulation" : "the first recording",
                            difference_text(comparison, worst->gap.dB), place(worst->gap.at),
                            amplitudes_text(comparison, axis, *worst));
    }
    // Where a curve stands out, it has said of the standard deviation what there is to say.
    std::string number;
    const ComparedNumber* worst = axis.worst_number();
    if (worst != nullptr && (worst != &axis.standard_deviation || curve.empty())) {
        number = worst_number_text(comparison.unit, axis, *worst);
    }
    if (!curve.empty() || !number.empty()) {
        return fmt::format("{}{}{}", curve, curve.empty() || number.empty() ? "" : "; ", number);
    }
    if (axis.allan.at.empty()) { return "there is no noise to compare"; }
    return (comparison.simulations > 0 ? "the recording differs no more than simulations do among themselves"
                                       : "the recordings differ no more than their uncertainty allows");
}

// A column for each axis.
std::string summary_text(const Comparison& comparison) {
    std::vector<std::string> heads;
    std::vector<TextRow> rows{{"std. deviation", comparison.unit.name, {}},
                              {comparison.simulations > 0 ? "   simulated" : "   of the other", "", {}},
                              {"excess kurtosis", "", {}},
                              {comparison.simulations > 0 ? "   simulated" : "   of the other", "", {}},
                              {"Allan deviation", "points outside", {}},
                              {"spectrum", "points outside", {}}};
    const auto other = [](const ComparedNumber& number, double per_unit) {
        if (!number.lo) { return fmt::format("{:.3g}", number.other * per_unit); }
        return fmt::format("{:.3g} to {:.3g}", *number.lo * per_unit, *number.hi * per_unit);
    };
    const auto outside = [](const ComparedCurve& curve) {
        return fmt::format("{} of {}", curve.points_outside(), curve.at.size());
    };
    for (const AxisComparison& axis : comparison.axes) {
        const double per_unit = comparison.unit.per_column_unit;
        heads.push_back(printable(axis.axis));
        const std::array cells{fmt::format("{:.4g}", axis.standard_deviation.recording * per_unit),
                               other(axis.standard_deviation, per_unit),
                               fmt::format("{:.3g}", axis.excess_kurtosis.recording),
                               other(axis.excess_kurtosis, 1.0),
                               outside(axis.allan),
                               outside(axis.spectrum)};
        for (std::size_t i = 0; i < cells.size(); ++i) { rows[i].cells.push_back(cells[i]); }
    }
    return text_table(heads, rows);
}

std::string next_text(const Comparison& comparison) {
    const bool any = std::ranges::any_of(comparison.axes, differs);
    std::string sentence;
    if (comparison.simulations > 0) {
        sentence = any ? fmt::format("`gyrolog diagnose {} --model {}` says what makes the difference.",
                                     shell_word(comparison.recording_name), shell_word(comparison.other_name))
                       : "use the model: it makes such recordings. `gyrolog diagnose` tests it harder.";
    } else {
        sentence = any ? "`gyrolog analyze` of each says which noise term differs."
                       : "nothing: the recordings agree, as far as their lengths can tell.";
    }
    return "\nwhat to do next\n" + wrapped_text("  - ", sentence);
}

std::string details_text(const Comparison& comparison) {
    std::string text = '\n' + explanation_text(comparison);
    for (const AxisComparison& axis : comparison.axes) {
        text += fmt::format("\n{}\n", printable(axis.axis)) + curves_text(comparison, axis) + '\n' +
                distribution_text(comparison, axis);
    }
    return text;
}

}  // namespace

std::string outcome_sentence(const Comparison& comparison, const AxisComparison& axis) {
    return axis.axis + ": " + outcome(comparison, axis);
}

std::string comparison_text(const Comparison& comparison, Wording wording) {
    std::string text;
    for (const AxisComparison& axis : comparison.axes) {
        text += wrapped_text(printable(axis.axis) + ": ", outcome(comparison, axis));
    }
    text += '\n' + summary_text(comparison) + next_text(comparison) + '\n';
    text += wrapped_text("", fmt::format("compared: {}, {}, against {}", printable(comparison.recording_name),
                                         duration_text(comparison.duration_s), other_text(comparison)));
    for (const std::string& note : comparison.notes) { text += wrapped_text("model: ", note); }
    if (wording == Wording::whole) { text += details_text(comparison); }
    if (!comparison.warnings.empty()) { text += '\n'; }
    for (const std::string& warning : comparison.warnings) { text += wrapped_text("warning: ", warning); }
    return text;
}

std::vector<std::string> comparison_facts(const Comparison& comparison) {
    std::string length = duration_text(comparison.duration_s);
    const std::string other = duration_text(comparison.other_duration_s);
    if (comparison.simulations == 0 && other != length) { length += " (the other " + other + ")"; }
    return {fmt::format("{:.6g} Hz", comparison.rate_hz), length, counted(comparison.samples, "sample")};
}

}  // namespace gyrolog
