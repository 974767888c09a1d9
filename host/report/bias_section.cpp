#include <fmt/format.h>

#include "host/formats/noise_unit.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/report/sections.hpp"

namespace gyrolog {
namespace {

Html means_of(const SensorPart& part) {
    const std::vector<ScaledUnit> units = printed_signal_units(part.unit);
    const char* mean = part.is_gyro() ? "bias, " : "mean, with gravity, ";
    HtmlTable list{cells_of({"axis"}), {}, "numbers"};
    for (const ScaledUnit& unit : units) { list.heads.push_back(Html::text(mean + unit.name)); }
    list.heads.push_back(Html::text("coverage factor"));
    for (const AxisReport& axis : part.axes) {
        HtmlRow row = cells_of({axis.axis});
        for (const ScaledUnit& unit : units) {
            row.push_back(
                Html::text(with_uncertainty(axis.bias.value * unit.per_column_unit,
                                            axis.bias.expanded_uncertainty * unit.per_column_unit)));
        }
        row.push_back(Html::text(fmt::format("{:.3g}", axis.bias.coverage_factor)));
        list.rows.push_back(std::move(row));
    }
    return table(list);
}

Html samples_of(const SensorPart& part) {
    HtmlTable list{cells_of({"axis"}), {}, "numbers"};
    const std::vector<ScaledUnit> units = printed_signal_units(part.unit);
    for (const ScaledUnit& unit : units) {
        list.heads.push_back(Html::text("standard deviation of a sample, " + unit.name));
    }
    list.heads.push_back(Html::text("excess kurtosis"));
    list.heads.push_back(Html::text("independent samples worth"));
    for (const AxisReport& axis : part.axes) {
        HtmlRow row = cells_of({axis.axis});
        for (const ScaledUnit& unit : units) {
            row.push_back(Html::text(in_digits(axis.bias.sample_sd * unit.per_column_unit, 4)));
        }
        row.push_back(Html::text(in_digits(axis.bias.excess_kurtosis, 3)));
        row.push_back(Html::text(in_digits(axis.bias.effective_samples, 3)));
        list.rows.push_back(std::move(row));
    }
    return table(list);
}

Html gravity_of(const AccelerometerReport& report) {
    if (report.gravity.empty()) { return {}; }
    const SensorUnit unit = report.unit.is_counts() ? report.unit : SensorUnit::g();
    HtmlTable list{cells_of({"unit", "gravity, " + unit.name, "tilt, °", "up"}), {}, "numbers"};
    const auto number = [](const ExpandedNumber& n, double scale) {
        return with_uncertainty(n.value * scale, n.expanded_uncertainty * scale);
    };
    for (const AccelerometerReport::UnitGravity& of : report.gravity) {
        list.rows.push_back(
            cells_of({of.unit.empty() ? "1" : of.unit, number(of.gravity.size, unit.per_column_unit),
                      number(of.gravity.tilt_rad, deg_per_rad), of.gravity.up_name()}));
    }
    return table(list);
}

// The means, and what is in them.
Html bias_itself(const SensorPart& part) {
    if (part.is_gyro()) {
        return means_of(part) +
               paragraph(
                   "± the expanded uncertainty (95.45 %) of a bias of a sensor at rest, with what its own "
                   "low-frequency noise leaves open.",
                   "muted");
    }
    return means_of(part) + gravity_of(*part.page.analysis.accelerometer) +
           paragraph(
               "± the expanded uncertainty (95.45 %), as far as this record's noise goes: the axes' own "
               "biases "
               "and scale factors are in the mean, in gravity and in the tilt, which is that of the axis "
               "nearest to the vertical.",
               "muted");
}

Html course_of(const SensorPart& part) {
    const bool has_temperature = part.page.temperature.has_value();
    const std::string signal = part.is_gyro() ? "rate" : "specific force";
    const std::string mean = part.is_gyro() ? "bias" : "mean";
    Html course = figure_in_parts(
        part.figures.course_pngs,
        has_temperature
            ? "Mean " + signal + " over time, temperature over time, mean " + signal + " over temperature"
            : "Mean " + signal + " over time",
        "Means over equal parts of the record, about the " + mean + "." +
            (has_temperature ? " A drift that merely happened while the temperature changed "
                               "looks the same here as one that the temperature caused."
                             : ""));
    if (!has_temperature) {
        course += paragraph("The recording has no temperature (temp_C): what the bias does with it is open.",
                            "muted");
    }
    return course;
}

}  // namespace

Html bias_section(const SensorPart& part) {
    const std::string mean = part.is_gyro() ? "bias" : "mean";
    return element("h2", Html::text((part.is_gyro() ? "Bias" : "Mean and gravity") + part.of)) +
           bias_itself(part) + samples_of(part) +
           figure_in_parts(part.figures.samples_pngs,
                           "Histogram of the samples of each axis about the " + mean,
                           "The samples about the " + mean +
                               ", beside the Gaussian of equal standard deviation (dashed).") +
           course_of(part);
}

}  // namespace gyrolog
