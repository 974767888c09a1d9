// The key to a panel: a table with a sample of each curve's line, its name and its values. Where there are
// columns of values, curves that have a name only follow below the table, side by side. Last come the panel's
// notes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/canvas.hpp"
#include "analysis/plot/figure.hpp"
#include "analysis/plot/placement.hpp"

namespace gyrolog {

class Legend {
public:
    // Takes the panel's curves that have legend cells. Panel and typeface must outlive it.
    Legend(const Panel& panel, const Typeface& typeface, double scale)
        : Legend(panel, typeface, scale, std::nullopt) {}
    // All names side by side, on lines of that width.
    static Legend in_lines(const Panel& panel, const Typeface& typeface, double scale, double line_px) {
        return {panel, typeface, scale, line_px};
    }

    bool empty() const { return rows_.empty() && keys_.empty() && notes_.empty(); }
    Size size() const { return size_; }
    void draw(Canvas& canvas, const Box& box) const;

private:
    Legend(const Panel& panel, const Typeface& typeface, double scale, std::optional<double> line_px);

    struct Row {
        const Curve* curve;
        std::vector<std::string> cells;
    };
    struct Key {
        const Curve* curve;
        std::string name;
        double left_px;  // from the legend's edge
        int line;        // below the table
    };

    void widen_columns(const std::vector<std::string>& cells);
    void arrange_keys(double line_px);
    double width_px(const std::string& text) const;
    void draw_sample(Canvas& canvas, Point left_middle, const Curve& curve) const;
    void draw_cells(Canvas& canvas, Point left_middle, const std::vector<std::string>& cells,
                    Colour colour) const;

    const Typeface& typeface_;
    double scale_;
    std::vector<std::string> header_;
    std::vector<Row> rows_;
    std::vector<Key> keys_;
    std::vector<std::string> notes_;
    std::vector<double> column_px_;
    Size size_;
};

}  // namespace gyrolog
