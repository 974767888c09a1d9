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
    Box plot;
    Axis x;
    Axis y;
    std::optional<Axis> right;
};

class AxesDrawing {
public:
    AxesDrawing(const Panel& panel, Range x_range, Range y_range, const Typeface& typeface, double scale);

    // The margins that axes filling this area would need. Ticks depend on the plot's size and the size on the
    // ticks' labels, so this is settled in rounds; two are enough because labels of one axis differ little in
    // width.
    Margins margins(const Box& area) const;

    Axes lay_out(const Box& area, const Margins& margins) const;

    void draw_grid(Canvas& canvas, const Axes& axes) const;
    std::vector<Box> draw_guides(Canvas& canvas, const Axes& axes) const;  // returns the boxes of their words
    std::vector<Box> draw_frame(Canvas& canvas,
                                const Axes& axes) const;  // returns the boxes of the tick labels

private:
    Axis axis(const Scale& scale, const AxisSpec& spec, bool is_upright) const;
    double label_width_px(const Axis& axis) const;
    void draw_ticks(Canvas& canvas, const Axes& axes) const;
    void draw_titles(Canvas& canvas, const Axes& axes) const;

    const Panel& panel_;
    Range x_range_;
    Range y_range_;
    const Typeface& typeface_;
    double scale_;
};

}  // namespace gyrolog
