#include "analysis/plot/course_figure.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {
namespace {

// Heights at scale 1.
constexpr double heading_px = 110.0;
constexpr double course_panel_px = 430.0;
constexpr double temperature_panel_px = 310.0;
constexpr std::array course_markers{Marker::circle,  Marker::square,        Marker::triangle,
                                    Marker::diamond, Marker::triangle_down, Marker::hexagon};

struct TimeAxis {
    std::string title;
    std::vector<double> middles;  // of the parts
};

TimeAxis time_axis(const CourseFigure& course, std::size_t parts) {
    const bool is_long = course.duration_s > hours_from_s;
    const double length = is_long ? course.duration_s / s_per_h : course.duration_s;
    TimeAxis axis{is_long ? "time (h)" : "time (s)", {}};
    for (std::size_t part = 0; part < parts; ++part) {
        axis.middles.push_back((static_cast<double>(part) + 0.5) * length / static_cast<double>(parts));
    }
    return axis;
}

std::string rate_title(const CourseFigure& course) {
    return course.signal_name + " − " + course.mean_name + " (" + course.unit_name + ")";
}

Curve curve_of(const CourseFigure& course, std::size_t trace, const std::vector<double>& x) {
    Curve curve;
    curve.x = x;
    for (const double mean : course.traces[trace].means) {
        curve.y.push_back(mean * course.per_unit_of_data);
    }
    curve.stroke = {colours::cycle.at(trace % colours::cycle.size()), 2.0, {}};
    curve.marker = course_markers.at(trace % course_markers.size());
    curve.legend = {course.traces[trace].name};
    return curve;
}

Panel time_panel(const CourseFigure& course, const TimeAxis& time) {
    Panel panel;
    panel.x = {time.title, ScaleKind::linear, {}};
    panel.y = {rate_title(course), ScaleKind::linear, {}};
    for (std::size_t trace = 0; trace < course.traces.size(); ++trace) {
        panel.curves.push_back(curve_of(course, trace, time.middles));
        panel.curves.back().markers_apart_px = 60.0;
    }
    panel.legend_place = LegendPlace::beside;
    panel.height_share = course_panel_px;
    return panel;
}

Panel temperature_panel(const CourseFigure& course, const TimeAxis& time) {
    Panel panel;
    panel.x = {time.title, ScaleKind::linear, {}};
    panel.y = {"temperature (°C)", ScaleKind::linear, {}};
    Curve& curve = panel.curves.emplace_back();
    curve.x = time.middles;
    curve.y = course.temperature_degC;
    panel.height_share = temperature_panel_px;
    return panel;
}

// The parts of the record as points: between them nothing is known of another temperature.
Panel over_temperature_panel(const CourseFigure& course) {
    Panel panel;
    panel.x = {"temperature (°C)", ScaleKind::linear, {}};
    panel.y = {rate_title(course), ScaleKind::linear, {}};
    for (std::size_t trace = 0; trace < course.traces.size(); ++trace) {
        Curve& curve = panel.curves.emplace_back(curve_of(course, trace, course.temperature_degC));
        curve.stroke.width_px = 0.0;
        curve.markers_apart_px = 0.0;
    }
    panel.legend_place = LegendPlace::beside;
    panel.height_share = course_panel_px;
    return panel;
}

}  // namespace

Figure figure_of(const CourseFigure& course) {
    Figure figure;
    figure.title = course.title;
    figure.source = course.source;
    figure.facts = course.facts;
    figure.width_px = course.paper.width_px();
    figure.scale = course.paper.scale();
    const std::size_t parts = course.traces.empty() ? 0 : course.traces.front().means.size();
    const TimeAxis time = time_axis(course, parts);
    figure.panels.push_back(time_panel(course, time));
    double height_px = heading_px + course_panel_px;
    if (!course.temperature_degC.empty()) {
        figure.panels.push_back(temperature_panel(course, time));
        figure.panels.push_back(over_temperature_panel(course));
        height_px += temperature_panel_px + course_panel_px;
    }
    figure.height_px = course.paper.scaled_pixels(height_px);
    return figure;
}

Rendering render(const CourseFigure& course) { return render(figure_of(course)); }

}  // namespace gyrolog
