#include "host/app/report_figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/plot/course_figure.hpp"
#include "analysis/plot/unit_spread_figure.hpp"
#include "analysis/recording/course.hpp"
#include "host/app/analysis_plot.hpp"
#include "host/app/diagnosis_output.hpp"
#include "host/app/recording_diagnosis_run.hpp"
#include "host/base/counted.hpp"
#include "host/formats/uncertain_number.hpp"
#include "host/report/fleet_page.hpp"

namespace gyrolog {
namespace {

// The page's column on A4, and in pixels twice what it has on a screen.
constexpr PaperSize page_column{176.0, 230.9};
constexpr double deviation_height_mm = 126.5;
constexpr double spectrum_height_mm = 99.0;
// Two of them and the time panels of the course fill a page.
constexpr double samples_height_mm = 58.0;
constexpr double course_over_time_mm = 100.0;  // with the temperature
constexpr double course_panel_mm = 60.0;
// Of a diagnosis, without its heading: with the verdict above it fills a page.
constexpr double diagnosis_height_share = 0.84;
constexpr std::size_t course_parts_most = 100;
constexpr std::size_t samples_of_part_least = 10;

Result<Png> drawn(const char* what, const Figure& figure) {
    Rendering rendering = render(figure);
    if (!rendering.ok()) {
        return Error{ErrorCode::failed, fmt::format("draw the {}: {}", what, rendering.problem)};
    }
    return std::move(rendering.png);
}

// The page says what was recorded.
Figure on_page(Figure figure) {
    figure.title.clear();
    figure.source.clear();
    figure.facts.clear();
    return figure;
}

// A panel of a figure by itself.
Figure panel_alone(const Figure& of, std::size_t panel, double height_mm) {
    Figure figure = of;
    figure.panels = {of.panels.at(panel)};
    figure.height_px = page_column.pixels(height_mm);
    return figure;
}

// So that a page may end between two; a figure whose panels share a key stays whole.
Result<std::vector<Png>> drawn_one_by_one(const char* what, const Figure& figure, double height_mm) {
    std::vector<Png> pngs;
    const std::size_t panels = figure.key.empty() ? figure.panels.size() : 1;
    for (std::size_t i = 0; i < panels; ++i) {
        Figure one = figure;
        if (figure.key.empty()) { one = panel_alone(figure, i, height_mm); }
        GYROLOG_TRY(Png png, drawn(what, one));
        pngs.push_back(std::move(png));
    }
    return pngs;
}

Status draw_analysis(const AnalysisReport& analysis, SensorKind sensor, SensorFigures& drawn_ones) {
    AllanFigure allan = analysis_figure(analysis, sensor);
    allan.paper = page_column;
    const Figure both = on_page(figure_of(allan));
    GYROLOG_TRY(drawn_ones.deviation_png,
                drawn("Allan deviation", panel_alone(both, 0, deviation_height_mm)));
    if (both.panels.size() > 1) {
        GYROLOG_TRY(drawn_ones.spectrum_png, drawn("spectrum", panel_alone(both, 1, spectrum_height_mm)));
    }
    return {};
}

std::size_t parts_of(const Recording& recording) {
    return std::clamp<std::size_t>(recording.rows() / samples_of_part_least, 1, course_parts_most);
}

void set_units(CourseFigure& course, const SensorUnit& unit) {
    if (unit.sensor == SensorKind::accelerometer) {
        course.signal_name = "specific force";
        course.mean_name = "mean";
    }
    if (unit.is_counts()) {
        course.unit_name = "lsb";
    } else if (unit.sensor == SensorKind::gyro) {
        course.per_unit_of_data = deg_per_rad;
    } else {
        course.unit_name = "g";
        course.per_unit_of_data = SensorUnit::g().per_column_unit;
    }
}

CourseFigure course_figure(const AnalysisReport& analysis, const Recording& recording, SensorKind sensor) {
    const bool is_gyro = sensor == SensorKind::gyro;
    CourseFigure course;
    course.paper = page_column;
    course.duration_s = analysis.duration_s;
    set_units(course, is_gyro ? analysis.unit : analysis.accelerometer->unit);
    const std::size_t parts = parts_of(recording);
    for (const AxisReport& axis : is_gyro ? analysis.axes : analysis.accelerometer->axes) {
        const Column* column = recording.find((is_gyro ? "g" : "a") + axis.axis);
        if (column == nullptr) { continue; }
        CourseTrace& trace = course.traces.emplace_back(CourseTrace{axis.axis, {}});
        trace.means = course_of(recording, *column, parts);
        for (double& mean : trace.means) { mean -= axis.bias.value; }
    }
    if (const Column* temperature = recording.find("temp")) {
        course.temperature_degC = course_of(recording, *temperature, parts);
    }
    return course;
}

// What goes over time keeps one time axis.
Status draw_course(const Figure& course, SensorFigures& drawn_ones) {
    const char* what = "course of the bias";
    const bool has_temperature = course.panels.size() > 1;
    Figure over_time = course;
    if (has_temperature) { over_time.panels.pop_back(); }
    over_time.height_px = page_column.pixels(has_temperature ? course_over_time_mm : course_panel_mm);
    GYROLOG_TRY(Png time_png, drawn(what, over_time));
    drawn_ones.course_pngs.push_back(std::move(time_png));
    if (!has_temperature) { return {}; }
    GYROLOG_TRY(Png temperature_png,
                drawn(what, panel_alone(course, course.panels.size() - 1, course_panel_mm)));
    drawn_ones.course_pngs.push_back(std::move(temperature_png));
    return {};
}

Status draw_sensor(const AnalysisReport& analysis, const Recording& recording, SensorKind sensor,
                   SensorFigures& drawn_ones) {
    GYROLOG_CHECK(draw_analysis(analysis, sensor, drawn_ones));
    HistogramFigure samples = samples_figure(analysis, recording, sensor);
    samples.paper = page_column;
    GYROLOG_TRY(drawn_ones.samples_pngs,
                drawn_one_by_one("histogram", on_page(figure_of(samples)), samples_height_mm));
    return draw_course(on_page(figure_of(course_figure(analysis, recording, sensor))), drawn_ones);
}

AxisUnits plotted_units(const UnitsOfParameter& of) {
    AxisUnits axis{of.axis.empty() ? "all" : of.axis, {}, {}};
    for (const UnitValue& unit : of.units) {
        axis.units.push_back({std::filesystem::path(unit.unit).filename().string(), unit.value,
                              unit.uncertainty, unit.stands_out});
    }
    if (of.spread) { axis.spread = PlottedSpread{of.spread->median, of.spread->sd}; }
    return axis;
}

}  // namespace

Result<Png> draw_spread(const UnitPopulation& population) {
    constexpr std::size_t units_least = 2;
    UnitSpreadFigure spread;
    spread.paper = page_column;
    for (const PopulationParameter& parameter : population_parameters) {
        const char* title = parameter.name == std::string_view("rate_hz") ? parameter.title : parameter.name;
        UnitParameter plotted{fmt::format("{} ({})", title, parameter.unit), {}};
        for (const UnitsOfParameter& of : population.parameters) {
            const bool is_shown = of.name == parameter.name && of.units.size() >= units_least;
            if (is_shown) { plotted.axes.push_back(plotted_units(of)); }
        }
        if (!plotted.axes.empty()) { spread.parameters.push_back(std::move(plotted)); }
    }
    if (spread.parameters.empty()) { return Png(); }
    return drawn("spread between units", figure_of(spread));
}

Status draw_figures(ReportPage& page, const Recording& recording) {
    const AnalysisReport& analysis = page.analysis;
    if (!analysis.axes.empty()) {
        GYROLOG_CHECK(draw_sensor(analysis, recording, SensorKind::gyro, page.gyro));
    }
    if (analysis.accelerometer) {
        GYROLOG_CHECK(draw_sensor(analysis, recording, SensorKind::accelerometer, page.accelerometer));
    }
    if (page.diagnosis == nullptr) { return {}; }
    DiagnosisFigure diagnosis = titled_figure(*page.diagnosis, "recording", diagnosis_facts(*page.diagnosis));
    diagnosis.paper = page_column;
    Figure figure = on_page(figure_of(diagnosis));
    figure.height_px = static_cast<int>(figure.height_px * diagnosis_height_share);
    GYROLOG_TRY(page.diagnosis_png, drawn("diagnosis", figure));
    return {};
}

}  // namespace gyrolog
