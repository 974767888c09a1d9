// One panel: axes, curves with their bands, marked points, legend.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/axes.hpp"
#include "analysis/plot/canvas.hpp"
#include "analysis/plot/figure.hpp"
#include "analysis/plot/legend.hpp"
#include "analysis/plot/placement.hpp"

namespace gyrolog {

class PanelDrawing {
public:
    // Keeps references: the panel and the typeface must outlive it.
    PanelDrawing(const Panel& panel, const Typeface& typeface, double scale);

    // What axes and a legend beside them need.
    Margins margins(const Box& area) const;

    // Draws into the area with these margins around the plot. The legend goes where it covers no data, or
    // else below the plot; it is left out where it would take most of the panel.
    PanelPlace draw(Canvas& canvas, const Box& area, const Margins& margins) const;

private:
    // A curve as it lies in the plot.
    struct Trace {
        const Curve* curve;
        std::vector<Polyline> lines;
        std::vector<Polyline> bands;  // polygons
        std::vector<Point> markers;
    };
    struct Word {
        std::string text;
        Box box;
        Colour colour;
    };

    struct Arrangement {
        Axes axes;
        std::vector<Trace> traces;
        std::vector<Word> words;
        std::optional<Box> legend;

        bool shows_data() const;
    };

    Trace trace_of(const Curve& curve, const Axes& axes) const;
    std::vector<Polyline> bands_of(const Curve& curve, const Axes& axes) const;
    Obstacles obstacles_for_words(const Axes& axes, const std::vector<Trace>& traces) const;
    Obstacles obstacles_for_legend(const Arrangement& arranged, bool only_data) const;
    std::vector<Word> place_words(const Axes& axes, const std::vector<Trace>& traces) const;
    Arrangement arrange(const Box& area, const Margins& margins) const;
    Arrangement arrange_with_legend(const Box& area, const Margins& margins, const Legend& legend) const;
    bool stands_beside(const Box& area, const Margins& own, const Legend& legend) const;
    Legend legend_for(const Box& area) const;  // smaller where the area is narrow
    void draw_traces(Canvas& canvas, const std::vector<Trace>& traces) const;
    void draw_points(Canvas& canvas, const Axes& axes) const;

    const Panel& panel_;
    const Typeface& typeface_;
    double scale_;
    AxesDrawing axes_;
};

}  // namespace gyrolog
