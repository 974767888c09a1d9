// The frame of a panel: its scales, their ticks, labels and titles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/canvas.hpp"
#include "analysis/plot/figure.hpp"

namespace gyrolog {

// What the labels and titles need around the plot.
struct Margins {
    double left_px = 0.0;
    double right_px = 0.0;
    double top_px = 0.0;
    double bottom_px = 0.0;
};

struct Axis {
    Scale scale;
    Ticks ticks;
    std::string title;
};

struct Axes {
    Box area;
    Box plot;
    Axis x;
    Axis y;
    std::optional<Axis> right;
};

class AxesDrawing {
public:
    AxesDrawing(const Panel& panel, Range x_range, Range y_range, const Typeface& typeface, double scale);

    // The margins that axes filling this area would need: none for a title that is empty. Ticks depend on the
    // plot's size and the size on the ticks' labels, so this is settled in rounds; two are enough because
    // labels of one axis differ little in width.
    Margins margins(const Box& area) const;

    Axes lay_out(const Box& area, const Margins& margins) const;

    void draw_grid(Canvas& canvas, const Axes& axes) const;
    std::vector<Box> draw_guides(Canvas& canvas, const Axes& axes) const;  // returns the boxes of their words
    std::vector<Box> draw_frame(Canvas& canvas,
                                const Axes& axes) const;  // returns the boxes of the tick labels

private:
    Axis axis(const Scale& scale, const AxisSpec& spec, bool is_upright) const;
    double label_width_px(const Axis& axis) const;
    // One line, or two where one is longer than the room; what even they do not hold is shortened.
    std::vector<std::string> title_lines(const std::string& title, double size_px, double room_px) const;
    double title_room_px(const std::string& title, double room_px) const;  // beyond the labels
    double caption_room_px(double room_px) const;
    void draw_ticks(Canvas& canvas, const Axes& axes) const;
    void draw_titles(Canvas& canvas, const Axes& axes) const;
    void draw_caption(Canvas& canvas, const Axes& axes) const;

    const Panel& panel_;
    Range x_range_;
    Range y_range_;
    const Typeface& typeface_;
    double scale_;
};

}  // namespace gyrolog
