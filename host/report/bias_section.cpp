#include <fmt/format.h>

#include "host/formats/noise_unit.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/report/sections.hpp"

namespace gyrolog {
namespace {

Html biases_of(const AnalysisReport& analysis) {
    const std::vector<ScaledUnit> units = printed_rate_units(analysis.unit);
    HtmlTable list{cells_of({"axis"}), {}, "numbers"};
    for (const ScaledUnit& unit : units) { list.heads.push_back(Html::text("bias, " + unit.name)); }
    list.heads.push_back(Html::text("coverage factor"));
    for (const AxisReport& axis : analysis.axes) {
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

Html samples_of(const AnalysisReport& analysis) {
    HtmlTable list{cells_of({"axis"}), {}, "numbers"};
    const std::vector<ScaledUnit> units = printed_rate_units(analysis.unit);
    for (const ScaledUnit& unit : units) {
        list.heads.push_back(Html::text("standard deviation of a sample, " + unit.name));
    }
    list.heads.push_back(Html::text("excess kurtosis"));
    list.heads.push_back(Html::text("independent samples worth"));
    for (const AxisReport& axis : analysis.axes) {
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

Html course_of(const ReportPage& page) {
    const bool has_temperature = page.temperature.has_value();
    Html course = figure(
        page.course_png,
        has_temperature ? "Mean rate over time, temperature over time, mean rate over temperature"
                        : "Mean rate over time",
        has_temperature
            ? "Means over equal parts of the record, about the bias. A drift that merely happened while the "
              "temperature changed looks the same here as one that the temperature caused."
            : "Means over equal parts of the record, about the bias.");
    if (!has_temperature) {
        course += paragraph("The recording has no temperature (temp_C): what the bias does with it is open.",
                            "muted");
    }
    return course;
}

}  // namespace

Html bias_section(const ReportPage& page) {
    return element("h2", Html::text("Bias")) + biases_of(page.analysis) +
           paragraph(
               "± the expanded uncertainty (95.45 %) of a bias of a sensor at rest, with what its own "
               "low-frequency noise leaves open.",
               "muted") +
           samples_of(page.analysis) +
           figure(page.samples_png, "Histogram of the samples of each axis about the bias",
                  "The samples about the bias, beside the Gaussian of equal standard deviation (dashed).") +
           course_of(page);
}

}  // namespace gyrolog
