#include "analysis/plot/axes.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/plot/number_text.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double title_text_px = 20.0;
constexpr double tick_px = 8.0;
constexpr double minor_tick_px = 4.0;
constexpr double label_gap_px = 7.0;
constexpr double caption_gap_px = 12.0;  // a label at the plot's upper end reaches above it
constexpr double guide_line_px = letter_px + label_gap_px;  // words of guides, between caption and plot
constexpr double title_gap_px = 9.0;
constexpr double labels_apart_px = 14.0;
constexpr double edge_px = 3.0;
constexpr double fine_grid_apart_px = 13.0;  // on average; a denser fine grid only greys the paper

// From one line of a title to the next.
constexpr double title_line_px = 24.0;

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
    const double size_px = letter_px * scale_;
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
        widest_px = std::max(widest_px, typeface_.measure(tick.label, letter_px * scale_).width_px);
    }
    return widest_px;
}

std::vector<std::string> AxesDrawing::title_lines(const std::string& title, double size_px,
                                                  double room_px) const {
    const auto width_px = [&](const std::string& line) { return typeface_.measure(line, size_px).width_px; };
    std::vector<std::string> lines{title};
    double narrowest_px = width_px(title);
    if (title.empty() || narrowest_px <= room_px) { return lines; }
    for (std::size_t at = title.find(' '); at != std::string::npos; at = title.find(' ', at + 1)) {
        const std::vector<std::string> two{title.substr(0, at), title.substr(at + 1)};
        const double wider_px = std::max(width_px(two[0]), width_px(two[1]));
        if (wider_px >= narrowest_px) { continue; }
        narrowest_px = wider_px;
        lines = two;
    }
    for (std::string& line : lines) { line = typeface_.shortened(line, size_px, room_px, Ellipsis::end); }
    return lines;
}

double AxesDrawing::title_room_px(const std::string& title, double room_px) const {
    if (title.empty()) { return 2.0 * edge_px * scale_; }
    const auto lines = static_cast<double>(title_lines(title, title_text_px * scale_, room_px).size());
    return (title_gap_px + lines * title_line_px + edge_px) * scale_;
}

double AxesDrawing::caption_room_px(double room_px) const {
    const double guides_px = panel_.guides.empty() ? 0.0 : guide_line_px;
    if (panel_.caption.empty()) { return std::max(guides_px, 0.6 * letter_px) * scale_; }
    const auto lines = static_cast<double>(title_lines(panel_.caption, letter_px * scale_, room_px).size());
    return (guides_px + letter_px + caption_gap_px + (lines - 1.0) * title_line_px) * scale_;
}

Margins AxesDrawing::margins(const Box& area) const {
    const double up_to_labels_px = (tick_px + label_gap_px) * scale_;
    Margins margins{120.0 * scale_, 120.0 * scale_, 0.0, up_to_labels_px + letter_px * scale_};
    for (int round = 0; round < 2; ++round) {
        const Axes axes = lay_out(area, margins);
        const Box& plot = axes.plot;
        double half_x_label_px = 0.0;
        for (const Tick& tick : axes.x.ticks.ticks) {
            if (tick.label.empty()) { continue; }
            const double half_px = typeface_.measure(tick.label, letter_px * scale_).width_px / 2.0;
            half_x_label_px =
                std::max(half_x_label_px, axes.x.scale.pixel(tick.value) + half_px - plot.right);
        }
        margins.left_px =
            up_to_labels_px + label_width_px(axes.y) + title_room_px(axes.y.title, plot.height());
        margins.right_px = axes.right ? up_to_labels_px + label_width_px(*axes.right) +
                                            title_room_px(axes.right->title, plot.height())
                                      : half_x_label_px + 2.0 * edge_px * scale_;
        margins.top_px = caption_room_px(area.width());
        margins.bottom_px = up_to_labels_px + letter_px * scale_ + title_room_px(axes.x.title, plot.width());
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
    Axes axes{area, plot, axis(x, panel_.x, false), axis(y, panel_.y, true), {}};
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

// As wide as the panel: with numbers and names it is longer than a narrow plot.
void AxesDrawing::draw_caption(Canvas& canvas, const Axes& axes) const {
    const double size_px = letter_px * scale_;
    // The last one stands next to the plot.
    auto lines = title_lines(panel_.caption, size_px, axes.area.width());
    std::ranges::reverse(lines);
    const double guides_px = panel_.guides.empty() ? 0.0 : guide_line_px;
    double y = axes.plot.top - (guides_px + caption_gap_px) * scale_;
    for (const std::string& line : lines) {
        canvas.text(typeface_, line, {axes.area.left, y},
                    {size_px, colours::muted_ink, Across::left, Along::baseline});
        y -= title_line_px * scale_;
    }
}

void AxesDrawing::draw_titles(Canvas& canvas, const Axes& axes) const {
    const double size_px = title_text_px * scale_;
    const double line_px = title_line_px * scale_;
    const Box& plot = axes.plot;
    const double away_px = (tick_px + label_gap_px + title_gap_px) * scale_;
    double y = plot.bottom + away_px + letter_px * scale_;
    for (const std::string& line : title_lines(axes.x.title, size_px, plot.width())) {
        canvas.text(typeface_, line, {plot.centre().x, y},
                    {size_px, colours::ink, Across::centre, Along::top});
        y += line_px;
    }
    const auto left = title_lines(axes.y.title, size_px, plot.height());
    double x =
        plot.left - away_px - label_width_px(axes.y) - (static_cast<double>(left.size()) - 1.0) * line_px;
    for (const std::string& line : left) {
        canvas.text(typeface_, line, {x, plot.centre().y},
                    {size_px, colours::ink, Across::centre, Along::baseline, true});
        x += line_px;
    }
    if (!panel_.caption.empty()) { draw_caption(canvas, axes); }
    if (!axes.right) { return; }
    x = plot.right + away_px + label_width_px(*axes.right);
    for (const std::string& line : title_lines(axes.right->title, size_px, plot.height())) {
        canvas.text(typeface_, line, {x, plot.centre().y},
                    {size_px, colours::ink, Across::centre, Along::top, true});
        x += line_px;
    }
}

std::vector<Box> AxesDrawing::draw_guides(Canvas& canvas, const Axes& axes) const {
    std::vector<Box> words;
    for (const Guide& guide : panel_.guides) {
        const double x = axes.x.scale.pixel(guide.x);
        if (!(x > axes.plot.left && x < axes.plot.right)) { continue; }
        canvas.line({{x, axes.plot.top}, {x, axes.plot.bottom}},
                    Stroke{colours::guide, 1.0, {5.0, 4.0}}.scaled(scale_));
        const double half_px = typeface_.measure(guide.text, letter_px * scale_).width_px / 2.0;
        const double bottom = axes.plot.top - label_gap_px * scale_;
        const double middle = std::clamp(x, axes.area.left + half_px, axes.area.right - half_px);
        const Box box{middle - half_px, bottom - letter_px * scale_, middle + half_px, bottom};
        const bool is_free = std::none_of(words.begin(), words.end(), [&](const Box& word) {
            return word.grown(label_gap_px * scale_ / 2.0).overlaps(box);
        });
        if (!is_free) { continue; }
        canvas.text(typeface_, guide.text, {middle, bottom},
                    {letter_px * scale_, colours::muted_ink, Across::centre, Along::baseline});
        words.push_back(box);
    }
    return words;
}

std::vector<Box> AxesDrawing::draw_frame(Canvas& canvas, const Axes& axes) const {
    draw_ticks(canvas, axes);
    draw_titles(canvas, axes);
    const double size_px = letter_px * scale_;
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
