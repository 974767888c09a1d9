#include "analysis/plot/panel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/plot/paper_size.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double callout_marker_px = 12.0;
constexpr double clear_px = 14.0;
constexpr double lone_bar_px = 8.0;
constexpr double legend_gap_px = 16.0;

constexpr double range_margin = 0.04;
constexpr double least_decades = 1.0;
// A band widens a logarithmic axis by this factor beyond the curve at most: the last points of an Allan curve
// have one or two degrees of freedom, and their interval would squeeze all the others.
constexpr double band_widens_by = 3.0;
constexpr double least_plot_share = 0.35;
constexpr double least_legend_scale = 0.6;

struct Ranges {
    Range x;
    Range y;
};

bool can_show(double value, ScaleKind kind) {
    return std::isfinite(value) && (kind == ScaleKind::linear || value > 0.0);
}

void add_band_end(RangeFinder& finder, double end, double value, ScaleKind kind) {
    if (!can_show(end, kind)) { return; }
    if (kind == ScaleKind::logarithmic) {
        end = std::clamp(end, value / band_widens_by, value * band_widens_by);
    }
    finder.add(end);
}

Ranges ranges_of(const Panel& panel) {
    RangeFinder x(panel.x.kind);
    RangeFinder y(panel.y.kind);
    const auto add = [&](double at_x, double at_y) {
        if (!can_show(at_x, panel.x.kind) || !can_show(at_y, panel.y.kind)) { return false; }
        x.add(at_x);
        y.add(at_y);
        return true;
    };
    for (const Curve& curve : panel.curves) {
        if (!curve.sets_range) { continue; }
        for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
            if (!add(curve.x[i], curve.y[i])) { continue; }
            if (i < curve.lo.size()) { add_band_end(y, curve.lo[i], curve.y[i], panel.y.kind); }
            if (i < curve.hi.size()) { add_band_end(y, curve.hi[i], curve.y[i], panel.y.kind); }
        }
    }
    for (const Callout& callout : panel.callouts) { add(callout.x, callout.y); }
    return {panel.x.range.value_or(x.padded(range_margin, least_decades)),
            panel.y.range.value_or(y.padded(range_margin, least_decades))};
}

Point pixel_of(const Axes& axes, double x, double y) {
    return {axes.x.scale.pixel(x), axes.y.scale.pixel(y)};
}

bool is_shown(const Axes& axes, Point p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && axes.plot.contains(p);
}

Box around(Point centre, double half_px) {
    return {centre.x - half_px, centre.y - half_px, centre.x + half_px, centre.y + half_px};
}

Polyline with_steps(const Polyline& line) {
    Polyline stepped;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (i > 0) { stepped.push_back({line[i].x, line[i - 1].y}); }
        stepped.push_back(line[i]);
    }
    return stepped;
}

}  // namespace

PanelDrawing::PanelDrawing(const Panel& panel, const Typeface& typeface, double scale)
    : panel_(panel),
      typeface_(typeface),
      scale_(scale),
      axes_(panel, ranges_of(panel).x, ranges_of(panel).y, typeface, scale) {}

bool PanelDrawing::Arrangement::shows_data() const {
    return std::any_of(traces.begin(), traces.end(), [](const Trace& trace) {
        return trace.curve->sets_range && (!trace.lines.empty() || !trace.markers.empty());
    });
}

std::vector<Polyline> PanelDrawing::bands_of(const Curve& curve, const Axes& axes) const {
    std::vector<Polyline> bands;
    Polyline upper, lower;
    const auto close = [&] {
        if (upper.size() == 1) {  // a lone point's interval is a bar
            const double half_px = lone_bar_px * scale_ / 2.0;
            upper = {{upper[0].x - half_px, upper[0].y}, {upper[0].x + half_px, upper[0].y}};
            lower = {{lower[0].x - half_px, lower[0].y}, {lower[0].x + half_px, lower[0].y}};
        }
        upper.insert(upper.end(), lower.rbegin(), lower.rend());
        Polyline polygon = clip_polygon(upper, axes.plot);
        if (polygon.size() >= 3) { bands.push_back(std::move(polygon)); }
        upper.clear();
        lower.clear();
    };
    const std::size_t count = std::min({curve.x.size(), curve.lo.size(), curve.hi.size()});
    for (std::size_t i = 0; i < count; ++i) {
        const Point low = pixel_of(axes, curve.x[i], curve.lo[i]);
        const Point high = pixel_of(axes, curve.x[i], curve.hi[i]);
        if (std::isfinite(low.x) && std::isfinite(low.y) && std::isfinite(high.y)) {
            if (curve.shape == CurveShape::steps && !upper.empty()) {
                lower.push_back({low.x, lower.back().y});
                upper.push_back({high.x, upper.back().y});
            }
            lower.push_back(low);
            upper.push_back(high);
        } else {
            close();
        }
    }
    close();
    return bands;
}

PanelDrawing::Trace PanelDrawing::trace_of(const Curve& curve, const Axes& axes) const {
    Polyline line;
    for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
        line.push_back(pixel_of(axes, curve.x[i], curve.y[i]));
    }
    Trace trace{&curve, {}, bands_of(curve, axes), {}};
    if (curve.stroke.width_px > 0.0) {
        trace.lines = clip(curve.shape == CurveShape::steps ? with_steps(line) : line, axes.plot);
    }
    if (curve.marker == Marker::none) { return trace; }
    for (const Point& p : line) {
        if (!is_shown(axes, p)) { continue; }
        const bool is_near =
            !trace.markers.empty() && std::hypot(p.x - trace.markers.back().x, p.y - trace.markers.back().y) <
                                          curve.markers_apart_px * scale_;
        if (!is_near) { trace.markers.push_back(p); }
    }
    return trace;
}

Obstacles PanelDrawing::obstacles_for_words(const Axes& axes, const std::vector<Trace>& traces) const {
    Obstacles obstacles;
    for (const Trace& trace : traces) {
        for (const Polyline& line : trace.lines) { obstacles.add(line); }
        for (const Point& p : trace.markers) {
            obstacles.add(around(p, trace.curve->marker_size_px * scale_ / 2.0));
        }
    }
    for (const Guide& guide : panel_.guides) {
        const double x = axes.x.scale.pixel(guide.x);
        if (std::isfinite(x)) { obstacles.add(Polyline{{x, axes.plot.top}, {x, axes.plot.bottom}}); }
    }
    for (const Callout& callout : panel_.callouts) {
        const Point p = pixel_of(axes, callout.x, callout.y);
        if (is_shown(axes, p)) { obstacles.add(around(p, callout_marker_px * scale_ / 2.0)); }
    }
    return obstacles;
}

Obstacles PanelDrawing::obstacles_for_legend(const Arrangement& arranged, bool only_data) const {
    Obstacles obstacles;
    for (const Trace& trace : arranged.traces) {
        if (only_data && !trace.curve->sets_range) { continue; }
        for (const Polyline& line : trace.lines) { obstacles.add(line); }
        for (const Polyline& band : trace.bands) { obstacles.add_area(band); }
        for (const Point& p : trace.markers) {
            obstacles.add(around(p, trace.curve->marker_size_px * scale_ / 2.0));
        }
    }
    for (const Word& word : arranged.words) { obstacles.add(word.box); }
    for (const Callout& callout : panel_.callouts) {
        const Point p = pixel_of(arranged.axes, callout.x, callout.y);
        if (is_shown(arranged.axes, p)) { obstacles.add(around(p, callout_marker_px * scale_ / 2.0)); }
    }
    return obstacles;
}

std::vector<PanelDrawing::Word> PanelDrawing::place_words(const Axes& axes,
                                                          const std::vector<Trace>& traces) const {
    std::vector<Word> words;
    Obstacles obstacles = obstacles_for_words(axes, traces);
    const double size_px = letter_px * scale_;
    const double padding_px = 0.25 * size_px;
    for (const Callout& callout : panel_.callouts) {
        const Point p = pixel_of(axes, callout.x, callout.y);
        if (!is_shown(axes, p) || callout.text.empty()) { continue; }
        const Size size{typeface_.measure(callout.text, size_px).width_px + padding_px, size_px + padding_px};
        const double away_px = callout_marker_px * scale_;
        const auto box = callout.is_level ? place_level(p, away_px, size, axes.plot, obstacles)
                                          : place_beside(p, away_px, size, axes.plot, obstacles);
        if (!box) { continue; }
        obstacles.add(*box);
        words.push_back(
            {callout.text, box->grown(-padding_px / 2.0), callout.word_colour.value_or(callout.colour)});
    }
    return words;
}

PanelDrawing::Arrangement PanelDrawing::arrange(const Box& area, const Margins& margins) const {
    Arrangement arranged;
    arranged.axes = axes_.lay_out(area, margins);
    for (const Curve& curve : panel_.curves) { arranged.traces.push_back(trace_of(curve, arranged.axes)); }
    arranged.words = place_words(arranged.axes, arranged.traces);
    return arranged;
}

bool PanelDrawing::stands_beside(const Box& area, const Margins& own, const Legend& legend) const {
    if (panel_.legend_place != LegendPlace::beside || legend.empty()) { return false; }
    const Size size = legend.size();
    const double left_px = area.width() - own.left_px - own.right_px - size.width_px - legend_gap_px * scale_;
    return left_px > least_plot_share * area.width() &&
           size.height_px <= area.height() - own.top_px - own.bottom_px;
}

Margins PanelDrawing::margins(const Box& area) const {
    Margins margins = axes_.margins(area);
    const Legend legend = legend_for(area);
    if (stands_beside(area, margins, legend)) {
        margins.right_px += legend.size().width_px + legend_gap_px * scale_;
    }
    return margins;
}

PanelDrawing::Arrangement PanelDrawing::arrange_with_legend(const Box& area, const Margins& margins,
                                                            const Legend& legend) const {
    Arrangement arranged = arrange(area, margins);
    if (legend.empty() || !arranged.shows_data()) { return arranged; }
    const Size size = legend.size();
    const Margins own = axes_.margins(area);
    const bool has_room_beside = margins.right_px >= own.right_px + size.width_px;
    if (has_room_beside && stands_beside(area, own, legend)) {
        const double left = area.right - margins.right_px + own.right_px + legend_gap_px * scale_;
        const double top = arranged.axes.plot.top;
        arranged.legend = Box{left, top, left + size.width_px, top + size.height_px};
        return arranged;
    }
    // Slope lines and models are aids: rather than push the legend out of the plot, let it cover some.
    for (const bool only_data : {false, true}) {
        arranged.legend = place_in_corner(size, arranged.axes.plot, clear_px * scale_,
                                          obstacles_for_legend(arranged, only_data));
        if (arranged.legend) { return arranged; }
    }
    Margins wider = margins;
    wider.bottom_px += size.height_px + legend_gap_px * scale_;
    if (size.width_px > area.width() ||
        area.height() - wider.top_px - wider.bottom_px < least_plot_share * area.height()) {
        return arranged;
    }
    arranged = arrange(area, wider);
    const double left = std::clamp(arranged.axes.plot.centre().x - size.width_px / 2.0, area.left,
                                   area.right - size.width_px);
    arranged.legend = Box{left, area.bottom - size.height_px, left + size.width_px, area.bottom};
    return arranged;
}

Legend PanelDrawing::legend_for(const Box& area) const {
    const double width_px = Legend(panel_, typeface_, scale_).size().width_px;
    return Legend(panel_, typeface_,
                  scale_ * std::clamp(0.999 * area.width() / width_px, least_legend_scale, 1.0));
}

void PanelDrawing::draw_traces(Canvas& canvas, const std::vector<Trace>& traces) const {
    for (const Trace& trace : traces) {
        for (const Polyline& band : trace.bands) {
            canvas.fill(band, trace.curve->stroke.colour, trace.curve->band_opacity);
        }
    }
    for (const Trace& trace : traces) {
        for (const Polyline& line : trace.lines) { canvas.line(line, trace.curve->stroke.scaled(scale_)); }
    }
    for (const Trace& trace : traces) {
        for (const Point& p : trace.markers) {
            canvas.marker(p, trace.curve->marker, trace.curve->marker_size_px * scale_,
                          trace.curve->stroke.colour, trace.curve->marker_outline_px * scale_);
        }
    }
}

void PanelDrawing::draw_points(Canvas& canvas, const Axes& axes) const {
    for (const Callout& callout : panel_.callouts) {
        const Point p = pixel_of(axes, callout.x, callout.y);
        if (!is_shown(axes, p)) { continue; }
        canvas.marker(p, callout.marker, callout_marker_px * scale_, callout.colour, 1.5 * scale_);
        canvas.marker(p, callout.marker, callout_marker_px * 0.5 * scale_, colours::paper, 0.0);
    }
}

PanelPlace PanelDrawing::draw(Canvas& canvas, const Box& area, const Margins& margins) const {
    const Legend legend = legend_for(area);
    const Arrangement arranged = arrange_with_legend(area, margins, legend);
    const Axes& axes = arranged.axes;
    PanelPlace place{axes.plot, axes.x.scale, axes.y.scale, arranged.legend, {}, {}};

    axes_.draw_grid(canvas, axes);
    place.words = axes_.draw_guides(canvas, axes);
    draw_traces(canvas, arranged.traces);
    draw_points(canvas, axes);
    place.labels = axes_.draw_frame(canvas, axes);
    for (const Word& word : arranged.words) {
        canvas.text(typeface_, word.text, {word.box.left, word.box.centre().y},
                    {letter_px * scale_, word.colour, Across::left, Along::middle});
        place.words.push_back(word.box);
    }
    if (!arranged.shows_data()) {
        canvas.text(typeface_, "no data", axes.plot.centre(),
                    {1.6 * letter_px * scale_, colours::muted_ink, Across::centre, Along::middle});
    }
    if (arranged.legend) { legend.draw(canvas, *arranged.legend); }
    return place;
}

}  // namespace gyrolog
