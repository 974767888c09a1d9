#include "analysis/plot/unit_spread_figure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double unit_panel_px = 280.0;
constexpr double unit_key_px = 80.0;
constexpr double most_dot_px = 9.0;
constexpr double least_dot_px = 5.0;
constexpr double outlier_px = 13.0;
constexpr double bar_px = 1.3;

constexpr int spread_columns_most = 2;
constexpr double few_units = 20.0;      // have dots of full size
constexpr std::size_t apart_most = 40;  // of more units the dots touch
constexpr std::size_t names_most = 3;   // of an axis
constexpr double between_axes = 0.1;    // of an axis's width, at its sides
constexpr double widest_linear_ratio = 5.0;
constexpr double room_for_outliers = 1.5;  // of what the others span, above and below it
constexpr double edge_margin = 0.09;       // of the panel's height
constexpr double spread_opacity = 0.16;
constexpr std::size_t letters_of_name_most = 16;

constexpr Marker unit_marker = Marker::circle;
constexpr Marker outlier_marker = Marker::diamond;

// A scale's own measure, in which its lengths are.
double measure(double value, ScaleKind kind) { return kind == ScaleKind::linear ? value : std::log10(value); }
double value_at(double measured, ScaleKind kind) {
    return kind == ScaleKind::linear ? measured : std::pow(10.0, measured);
}

// Of the units that do not stand out; of all where there are no others.
std::vector<PlottedUnit> ordinary_units(const UnitParameter& parameter) {
    std::vector<PlottedUnit> ordinary;
    std::vector<PlottedUnit> all;
    for (const AxisUnits& axis : parameter.axes) {
        for (const PlottedUnit& unit : axis.units) {
            all.push_back(unit);
            if (!unit.stands_out) { ordinary.push_back(unit); }
        }
    }
    return ordinary.empty() ? all : ordinary;
}

ScaleKind kind_of(const std::vector<PlottedUnit>& units) {
    if (units.empty()) { return ScaleKind::linear; }
    const auto [least, most] = std::ranges::minmax_element(units, {}, &PlottedUnit::value);
    const bool is_wide = least->value > 0.0 && most->value > widest_linear_ratio * least->value;
    return is_wide ? ScaleKind::logarithmic : ScaleKind::linear;
}

// In the scale's measure. Of a logarithmic one the uncertainties do not widen it: they may reach below zero.
Range extent_of(const std::vector<PlottedUnit>& units, const UnitParameter& parameter, ScaleKind kind) {
    Range extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto add = [&](double value, double about) {
        const double beyond = kind == ScaleKind::linear ? about : 0.0;
        extent.lo = std::min(extent.lo, measure(value, kind) - beyond);
        extent.hi = std::max(extent.hi, measure(value, kind) + beyond);
    };
    for (const PlottedUnit& unit : units) { add(unit.value, unit.uncertainty); }
    for (const AxisUnits& axis : parameter.axes) {
        if (axis.spread) { add(axis.spread->median, axis.spread->sd); }
    }
    if (!(extent.hi > extent.lo)) {
        const double about = std::max(std::abs(extent.lo), 1.0) * 1e-3;
        extent = {extent.lo - about, extent.hi + about};
    }
    return extent;
}

// Of one panel; values on paper.
struct UnitScale {
    ScaleKind kind;
    Range shown;

    bool holds(double value) const { return value >= shown.lo && value <= shown.hi; }
};

UnitScale scale_of(const UnitParameter& parameter) {
    const std::vector<PlottedUnit> ordinary = ordinary_units(parameter);
    const ScaleKind kind = kind_of(ordinary);
    const Range extent = extent_of(ordinary, parameter, kind);
    const double room = room_for_outliers * (extent.hi - extent.lo);
    Range shown = extent;
    for (const AxisUnits& axis : parameter.axes) {
        for (const PlottedUnit& unit : axis.units) {
            const bool is_below_scale = kind == ScaleKind::logarithmic && !(unit.value > 0.0);
            const double at = is_below_scale ? extent.lo - room : measure(unit.value, kind);
            shown.lo = std::max(std::min(shown.lo, at), extent.lo - room);
            shown.hi = std::min(std::max(shown.hi, at), extent.hi + room);
        }
    }
    const double margin = edge_margin * (shown.hi - shown.lo);
    return {kind, {value_at(shown.lo - margin, kind), value_at(shown.hi + margin, kind)}};
}

double dot_px(std::size_t units) {
    const double smaller = std::sqrt(few_units / std::max(static_cast<double>(units), few_units));
    return std::max(least_dot_px, most_dot_px * smaller);
}

Curve dots_look(Colour colour, double size_px) {
    Curve dots;
    dots.stroke = {colour, 0.0, {}};
    dots.marker = unit_marker;
    dots.marker_size_px = size_px;
    dots.markers_apart_px = 0.0;
    return dots;
}

Curve outliers_look(Colour colour) {
    Curve outliers = dots_look(colour, outlier_px);
    outliers.marker = outlier_marker;
    return outliers;
}

// Paler where they touch, so that dots and median stay to be seen.
Curve bars_look(Colour colour, std::size_t units) {
    constexpr double paleness = 0.35;
    constexpr double paleness_of_many = 0.65;
    Curve bars;
    bars.stroke = {
        mixed(colour, colours::paper, units > apart_most ? paleness_of_many : paleness), bar_px, {}};
    bars.sets_range = false;
    return bars;
}

Curve spread_look() {
    Curve spread;
    spread.stroke = {colours::ink, 2.0, {}};
    spread.band_opacity = spread_opacity;
    return spread;
}

Curve triangle_look(Colour colour, bool is_above) {
    Curve beyond = dots_look(colour, outlier_px);
    beyond.marker = is_above ? Marker::triangle : Marker::triangle_down;
    return beyond;
}

std::string shortened(const std::string& name) {
    const std::u32string letters = decode_utf8(name);
    if (letters.size() <= letters_of_name_most) { return name; }
    return "…" + encode_utf8(std::u32string_view(letters).substr(letters.size() - letters_of_name_most + 1));
}

// The units of one axis between `left` and left + 1.
class AxisDots {
public:
    AxisDots(const AxisUnits& axis, const UnitScale& scale, double left, Colour colour)
        : axis_(axis),
          scale_(scale),
          left_(left),
          is_named_(std::ranges::count_if(axis.units, &PlottedUnit::stands_out) <=
                    static_cast<std::ptrdiff_t>(names_most)),
          dots_(dots_look(colour, dot_px(axis.units.size()))),
          bars_(bars_look(colour, axis.units.size())),
          outliers_(outliers_look(colour)),
          above_(triangle_look(colour, true)),
          below_(triangle_look(colour, false)) {
        if (axis.units.size() > apart_most) { dots_.marker_outline_px = 0.0; }
    }

    void add_to(Panel& panel) {
        std::vector<PlottedUnit> units = axis_.units;
        std::ranges::stable_sort(units, {}, &PlottedUnit::value);
        for (std::size_t i = 0; i < units.size(); ++i) {
            const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(units.size());
            add_unit(panel, units[i], left_ + between_axes + (1.0 - 2.0 * between_axes) * place);
        }
        if (!bars_.x.empty()) { panel.curves.push_back(bars_); }
        if (axis_.spread) { panel.curves.push_back(spread()); }
        for (const Curve* curve : {&dots_, &outliers_, &above_, &below_}) {
            if (!curve->x.empty()) { panel.curves.push_back(*curve); }
        }
    }

private:
    Curve spread() const {
        Curve curve = spread_look();
        const double median = axis_.spread->median;
        const double sd = axis_.spread->sd;
        curve.x = {left_ + between_axes / 2.0, left_ + 1.0 - between_axes / 2.0};
        curve.y = {median, median};
        curve.lo.assign(2, std::max(median - sd, scale_.shown.lo));
        curve.hi.assign(2, std::min(median + sd, scale_.shown.hi));
        return curve;
    }
    void add_unit(Panel& panel, const PlottedUnit& unit, double x) {
        std::string word = unit.stands_out && is_named_ ? shortened(unit.name) : "";
        double y = unit.value;
        Curve* dots = unit.stands_out ? &outliers_ : &dots_;
        if (!scale_.holds(y)) {
            const bool is_above = y > scale_.shown.hi;
            dots = is_above ? &above_ : &below_;
            word += (word.empty() ? "" : ": ") + rounded_number(y);
            y = edge(is_above);
        } else if (unit.uncertainty > 0.0) {
            add_bar(x, y, unit.uncertainty);
        }
        dots->x.push_back(x);
        dots->y.push_back(y);
        if (!word.empty()) { panel.callouts.push_back({x, y, word, colours::ink, Marker::none}); }
    }
    void add_bar(double x, double value, double uncertainty) {
        const double nowhere = std::numeric_limits<double>::quiet_NaN();
        bars_.x.insert(bars_.x.end(), {x, x, nowhere});
        bars_.y.insert(bars_.y.end(), {std::max(value - uncertainty, scale_.shown.lo),
                                       std::min(value + uncertainty, scale_.shown.hi), nowhere});
    }
    double edge(bool is_above) const {
        const double lo = measure(scale_.shown.lo, scale_.kind);
        const double hi = measure(scale_.shown.hi, scale_.kind);
        const double margin = edge_margin / 2.0 * (hi - lo);
        return value_at(is_above ? hi - margin : lo + margin, scale_.kind);
    }

    const AxisUnits& axis_;
    const UnitScale& scale_;
    double left_;
    bool is_named_;
    Curve dots_;
    Curve bars_;
    Curve outliers_;
    Curve above_;
    Curve below_;
};

Panel panel_of(const UnitParameter& parameter) {
    const UnitScale scale = scale_of(parameter);
    Panel panel;
    panel.y = {parameter.title, scale.kind, scale.shown};
    panel.x.range = Range{0.0, static_cast<double>(parameter.axes.size())};
    for (std::size_t i = 0; i < parameter.axes.size(); ++i) {
        const auto left = static_cast<double>(i);
        AxisDots(parameter.axes[i], scale, left, colours::cycle.at(i % colours::cycle.size())).add_to(panel);
        panel.x.names.push_back({left + 0.5, parameter.axes[i].axis});
    }
    panel.height_share = unit_panel_px;
    return panel;
}

bool has_marker(const std::vector<Panel>& panels, Marker marker) {
    return std::ranges::any_of(panels, [&](const Panel& panel) {
        return std::ranges::any_of(panel.curves, [&](const Curve& curve) { return curve.marker == marker; });
    });
}

// What the panels show, each once.
std::vector<Curve> key_of(const UnitSpreadFigure& spread, const std::vector<Panel>& panels) {
    std::vector<Curve> key;
    const auto add = [&](Curve row, const char* words) {
        row.legend = {words};
        key.push_back(std::move(row));
    };
    Curve unit = dots_look(colours::muted_ink, most_dot_px);
    unit.stroke.width_px = bar_px;
    add(unit, "unit ± standard uncertainty");
    if (has_marker(panels, outlier_marker)) { add(outliers_look(colours::muted_ink), "stands out"); }
    for (const bool is_above : {true, false}) {
        const Curve beyond = triangle_look(colours::muted_ink, is_above);
        if (!has_marker(panels, beyond.marker)) { continue; }
        add(beyond, is_above ? "above the panel" : "below the panel");
    }
    const bool has_spread = std::ranges::any_of(spread.parameters, [](const UnitParameter& parameter) {
        return std::ranges::any_of(parameter.axes, [](const AxisUnits& axis) { return bool(axis.spread); });
    });
    if (has_spread) {
        Curve row = spread_look();
        row.lo = row.hi = {0.0};
        add(row, "median ± spread between units");
    }
    return key;
}

}  // namespace

Figure figure_of(const UnitSpreadFigure& spread) {
    Figure figure;
    figure.width_px = spread.paper.width_px();
    figure.scale = spread.paper.scale();
    for (const UnitParameter& parameter : spread.parameters) { figure.panels.push_back(panel_of(parameter)); }
    const std::size_t count = figure.panels.size();
    figure.columns = std::min(spread.paper.columns_up_to(spread_columns_most),
                              static_cast<int>(std::max<std::size_t>(count, 1)));
    const auto columns = static_cast<std::size_t>(figure.columns);
    const std::size_t rows = (count + columns - 1) / columns;
    if (count % columns != 0) { figure.panels.back().spans_row = true; }
    const std::size_t last_row = rows == 0 ? 0 : (rows - 1) * columns;
    for (std::size_t i = last_row; i < count; ++i) {
        figure.panels[i].x.title = "axis; its units in the order of their values";
    }
    figure.key = key_of(spread, figure.panels);
    figure.height_px = spread.paper.scaled_pixels(unit_key_px + unit_panel_px * static_cast<double>(rows));
    return figure;
}

Rendering render(const UnitSpreadFigure& spread) { return render(figure_of(spread)); }

}  // namespace gyrolog
