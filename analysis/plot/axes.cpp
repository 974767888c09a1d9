#include "analysis/plot/axes.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/plot/number_text.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double label_text_px = 21.0;
constexpr double title_text_px = 23.0;
constexpr double tick_px = 8.0;
constexpr double minor_tick_px = 4.0;
constexpr double label_gap_px = 7.0;
constexpr double title_gap_px = 20.0;
constexpr double labels_apart_px = 14.0;
constexpr double edge_px = 4.0;
constexpr double fine_grid_apart_px = 13.0;  // on average; a denser fine grid only greys the paper
constexpr double guide_text_px = 19.0;

// Height a line of letters takes, from capitals' top to below the descenders.
constexpr double line_share = 1.05;

}  // namespace

AxesDrawing::AxesDrawing(const Panel& panel, Range x_range, Range y_range, const Typeface& typeface,
                         double scale)
    : panel_(panel), x_range_(x_range), y_range_(y_range), typeface_(typeface), scale_(scale) {}

Axis AxesDrawing::axis(const Scale& scale, const AxisSpec& spec, bool is_upright) const {
    Axis axis{scale, {}, spec.title};
    if (!spec.names.empty()) {
        for (const AxisName& name : spec.names) { axis.ticks.ticks.push_back({name.value, name.text}); }
        return axis;
    }
    const double size_px = label_text_px * scale_;
    const auto extent_px = [&](const std::string& label) {
        return is_upright ? size_px : typeface_.measure(label, size_px).width_px;
    };
    axis.ticks = fit_ticks(scale, labels_apart_px * scale_, extent_px);
    if (axis.ticks.exponent != 0) { axis.title += "   ×" + power_of_ten(axis.ticks.exponent); }
    return axis;
}

double AxesDrawing::label_width_px(const Axis& axis) const {
    double widest_px = 0.0;
    for (const Tick& tick : axis.ticks.ticks) {
        widest_px = std::max(widest_px, typeface_.measure(tick.label, label_text_px * scale_).width_px);
    }
    return widest_px;
}

Margins AxesDrawing::margins(const Box& area) const {
    const double beyond_labels_px = (title_gap_px + title_text_px * line_share + edge_px) * scale_;
    const double up_to_labels_px = (tick_px + label_gap_px) * scale_;
    const bool has_words_above = !panel_.guides.empty() || !panel_.caption.empty();
    const double above_px = has_words_above ? guide_text_px + label_gap_px : 0.6 * label_text_px;
    Margins margins{120.0 * scale_, 120.0 * scale_, above_px * scale_,
                    up_to_labels_px + label_text_px * scale_ + beyond_labels_px};
    for (int round = 0; round < 2; ++round) {
        const Axes axes = lay_out(area, margins);
        double half_x_label_px = 0.0;
        for (const Tick& tick : axes.x.ticks.ticks) {
            if (tick.label.empty()) { continue; }
            const double half_px = typeface_.measure(tick.label, label_text_px * scale_).width_px / 2.0;
            half_x_label_px =
                std::max(half_x_label_px, axes.x.scale.pixel(tick.value) + half_px - axes.plot.right);
        }
        margins.left_px = up_to_labels_px + label_width_px(axes.y) + beyond_labels_px;
        margins.right_px = axes.right ? up_to_labels_px + label_width_px(*axes.right) + beyond_labels_px
                                      : half_x_label_px + 2.0 * edge_px * scale_;
    }
    return margins;
}

Axes AxesDrawing::lay_out(const Box& area, const Margins& margins) const {
    // A figure too small for its labels still gets a plot, of one pixel if it must be.
    const double left = std::round(area.left + margins.left_px);
    const double top = std::round(area.top + margins.top_px);
    const Box plot{left, top, std::max(std::round(area.right - margins.right_px), left + 1.0),
                   std::max(std::round(area.bottom - margins.bottom_px), top + 1.0)};
    const Scale x{panel_.x.kind, x_range_, plot.left, plot.right};
    const Scale y{panel_.y.kind, y_range_, plot.bottom, plot.top};
    Axes axes{plot, axis(x, panel_.x, false), axis(y, panel_.y, true), {}};
    if (panel_.right) {
        Scale right = y;
        right.range = {y.range.lo * panel_.right->factor, y.range.hi * panel_.right->factor};
        axes.right = axis(right, {panel_.right->title, y.kind, {}, {}}, true);
    }
    return axes;
}

void AxesDrawing::draw_grid(Canvas& canvas, const Axes& axes) const {
    const auto is_loose = [&](const Axis& axis, double length_px) {
        return static_cast<double>(axis.ticks.ticks.size()) * fine_grid_apart_px * scale_ < length_px;
    };
    const bool fine_x = is_loose(axes.x, axes.plot.width());
    const bool fine_y = is_loose(axes.y, axes.plot.height());
    for (const bool is_major : {false, true}) {
        const Colour colour = is_major ? colours::grid : colours::fine_grid;
        for (const Tick& tick : axes.x.ticks.ticks) {
            if (tick.label.empty() == is_major || !(is_major || fine_x)) { continue; }
            const double x = axes.x.scale.pixel(tick.value);
            canvas.rule({x, axes.plot.top}, {x, axes.plot.bottom}, scale_, colour);
        }
        for (const Tick& tick : axes.y.ticks.ticks) {
            if (tick.label.empty() == is_major || !(is_major || fine_y)) { continue; }
            const double y = axes.y.scale.pixel(tick.value);
            canvas.rule({axes.plot.left, y}, {axes.plot.right, y}, scale_, colour);
        }
    }
}

void AxesDrawing::draw_ticks(Canvas& canvas, const Axes& axes) const {
    const double width_px = 1.4 * scale_;
    const auto length_px = [&](const Tick& tick) {
        return (tick.label.empty() ? minor_tick_px : tick_px) * scale_;
    };
    const Box& plot = axes.plot;
    for (const Tick& tick : axes.x.ticks.ticks) {
        const double x = axes.x.scale.pixel(tick.value);
        canvas.rule({x, plot.bottom}, {x, plot.bottom + length_px(tick)}, width_px, colours::ink);
    }
    for (const Tick& tick : axes.y.ticks.ticks) {
        const double y = axes.y.scale.pixel(tick.value);
        canvas.rule({plot.left - length_px(tick), y}, {plot.left, y}, width_px, colours::ink);
    }
    if (axes.right) {
        for (const Tick& tick : axes.right->ticks.ticks) {
            const double y = axes.right->scale.pixel(tick.value);
            canvas.rule({plot.right, y}, {plot.right + length_px(tick), y}, width_px, colours::ink);
        }
    }
    for (const double x : {plot.left, plot.right}) {
        canvas.rule({x, plot.top - width_px / 2.0}, {x, plot.bottom + width_px / 2.0}, width_px,
                    colours::ink);
    }
    for (const double y : {plot.top, plot.bottom}) {
        canvas.rule({plot.left - width_px / 2.0, y}, {plot.right + width_px / 2.0, y}, width_px,
                    colours::ink);
    }
}

void AxesDrawing::draw_titles(Canvas& canvas, const Axes& axes) const {
    const double size_px = title_text_px * scale_;
    const Box& plot = axes.plot;
    const double away_px = (tick_px + label_gap_px + title_gap_px) * scale_;
    const auto fitted = [&](const std::string& title, double room_px) {
        return typeface_.shortened(title, size_px, room_px, Ellipsis::end);
    };
    canvas.text(typeface_, fitted(axes.x.title, plot.width()),
                {plot.centre().x, plot.bottom + away_px + label_text_px * scale_},
                {size_px, colours::ink, Across::centre, Along::top});
    canvas.text(typeface_, fitted(axes.y.title, plot.height()),
                {plot.left - away_px - label_width_px(axes.y), plot.centre().y},
                {size_px, colours::ink, Across::centre, Along::baseline, true});
    if (!panel_.caption.empty()) {
        const double caption_px = guide_text_px * scale_;
        canvas.text(typeface_, typeface_.shortened(panel_.caption, caption_px, plot.width(), Ellipsis::end),
                    {plot.left, plot.top - label_gap_px * scale_},
                    {caption_px, colours::muted_ink, Across::left, Along::baseline});
    }
    if (axes.right) {
        canvas.text(typeface_, fitted(axes.right->title, plot.height()),
                    {plot.right + away_px + label_width_px(*axes.right), plot.centre().y},
                    {size_px, colours::ink, Across::centre, Along::top, true});
    }
}

std::vector<Box> AxesDrawing::draw_guides(Canvas& canvas, const Axes& axes) const {
    std::vector<Box> words;
    for (const Guide& guide : panel_.guides) {
        const double x = axes.x.scale.pixel(guide.x);
        if (!(x > axes.plot.left && x < axes.plot.right)) { continue; }
        canvas.line({{x, axes.plot.top}, {x, axes.plot.bottom}},
                    Stroke{colours::guide, 1.0, {5.0, 4.0}}.scaled(scale_));
        const double half_px = typeface_.measure(guide.text, guide_text_px * scale_).width_px / 2.0;
        const double bottom = axes.plot.top - label_gap_px * scale_;
        const Box box{x - half_px, bottom - guide_text_px * scale_, x + half_px, bottom};
        const bool is_free = std::none_of(words.begin(), words.end(), [&](const Box& word) {
            return word.grown(label_gap_px * scale_ / 2.0).overlaps(box);
        });
        if (!is_free) { continue; }
        canvas.text(typeface_, guide.text, {x, bottom},
                    {guide_text_px * scale_, colours::muted_ink, Across::centre, Along::baseline});
        words.push_back(box);
    }
    return words;
}

std::vector<Box> AxesDrawing::draw_frame(Canvas& canvas, const Axes& axes) const {
    draw_ticks(canvas, axes);
    draw_titles(canvas, axes);
    const double size_px = label_text_px * scale_;
    const double away_px = (tick_px + label_gap_px) * scale_;
    std::vector<Box> boxes;
    const auto put = [&](const Axis& axis, Point at, Across across, Along along) {
        for (const Tick& tick : axis.ticks.ticks) {
            if (tick.label.empty()) { continue; }
            const double along_px = axis.scale.pixel(tick.value);
            const Point here = along == Along::top ? Point{along_px, at.y} : Point{at.x, along_px};
            boxes.push_back(canvas.text(typeface_, tick.label, here, {size_px, colours::ink, across, along}));
        }
    };
    put(axes.x, {0.0, axes.plot.bottom + away_px}, Across::centre, Along::top);
    put(axes.y, {axes.plot.left - away_px, 0.0}, Across::right, Along::middle);
    if (axes.right) { put(*axes.right, {axes.plot.right + away_px, 0.0}, Across::left, Along::middle); }
    return boxes;
}

}  // namespace gyrolog
