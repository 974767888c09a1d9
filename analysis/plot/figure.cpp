#include "analysis/plot/figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "analysis/plot/canvas.hpp"
#include "analysis/plot/panel.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double figure_edge_px = 26.0;
constexpr double title_px = 30.0;
constexpr double fact_px = 19.0;
constexpr double fact_line_px = 28.0;
constexpr double after_heading_px = 14.0;
constexpr double between_panels_px = 14.0;
constexpr int largest_px = 16384;
constexpr double least_source_share = 0.25;

std::string size_text(double width_px, double height_px) {
    return std::to_string(std::lround(width_px)) + " x " + std::to_string(std::lround(height_px));
}

std::size_t columns_of(const Figure& figure) { return static_cast<std::size_t>(std::max(figure.columns, 1)); }

struct PanelRow {
    std::vector<std::size_t> panels;
    double share = 0.0;
    bool is_spanned = false;
};

std::vector<PanelRow> rows_of(const Figure& figure) {
    std::vector<PanelRow> rows;
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        const Panel& panel = figure.panels[i];
        const bool is_new = rows.empty() || panel.spans_row || rows.back().is_spanned ||
                            rows.back().panels.size() == columns_of(figure);
        if (is_new) { rows.push_back({{}, 0.0, panel.spans_row}); }
        rows.back().panels.push_back(i);
        rows.back().share = std::max(rows.back().share, panel.height_share);
    }
    return rows;
}

std::string problem_with(const Figure& figure) {
    if (!(figure.scale >= 0.1 && figure.scale <= 20.0)) {
        return "draw a figure of scale " + std::to_string(figure.scale) + ": scales go from 0.1 to 20";
    }
    double least_share = std::numeric_limits<double>::infinity();
    double sum = 0.0;
    for (const PanelRow& row : rows_of(figure)) {
        if (!(row.share > 0.0)) { return "draw a row of panels of no height"; }
        least_share = std::min(least_share, row.share);
        sum += row.share;
    }
    const double rows = sum / least_share;
    const double least_width_px = 480.0 * static_cast<double>(columns_of(figure)) * figure.scale;
    const double least_height_px = (130.0 + 230.0 * rows) * figure.scale;
    const bool fits = figure.width_px >= least_width_px && figure.height_px >= least_height_px &&
                      figure.width_px <= largest_px && figure.height_px <= largest_px;
    for (const Panel& panel : figure.panels) {
        for (const AxisSpec* axis : {&panel.x, &panel.y}) {
            if (axis->range && !can_scale(axis->kind, *axis->range)) {
                return "draw an axis from " + std::to_string(axis->range->lo) + " to " +
                       std::to_string(axis->range->hi) + ": not a range";
            }
        }
    }
    if (fits) { return {}; }
    return "draw a figure of " + size_text(figure.width_px, figure.height_px) +
           " pixels: with letters of this scale " + size_text(least_width_px, least_height_px) + " to " +
           size_text(largest_px, largest_px) + " is possible";
}

std::vector<Box> panel_areas(const Figure& figure, double top) {
    const double edge = figure_edge_px * figure.scale;
    const double gap_px = between_panels_px * figure.scale;
    const std::vector<PanelRow> rows = rows_of(figure);
    double shares = 0.0;
    for (const PanelRow& row : rows) { shares += row.share; }
    const auto columns = static_cast<double>(columns_of(figure));
    const double share_px =
        (figure.height_px - edge - top - gap_px * (static_cast<double>(rows.size()) - 1.0)) / shares;
    const double whole_px = figure.width_px - 2.0 * edge;
    const double column_px = (whole_px - gap_px * (columns - 1.0)) / columns;
    std::vector<Box> areas;
    for (const PanelRow& row : rows) {
        const double width_px = row.is_spanned ? whole_px : column_px;
        for (std::size_t column = 0; column < row.panels.size(); ++column) {
            const double left = edge + static_cast<double>(column) * (width_px + gap_px);
            areas.push_back({left, top, left + width_px, top + share_px * row.share});
        }
        top += share_px * row.share + gap_px;
    }
    return areas;
}

// Source and facts in as few lines as hold them. The source gets what the facts leave of the first line.
std::vector<std::string> fact_lines(const Figure& figure, const Typeface& typeface, double width_px) {
    const double size_px = fact_px * figure.scale;
    const auto width_of = [&](const std::string& text) { return typeface.measure(text, size_px).width_px; };
    const std::string separator = "  ·  ";
    std::string facts;
    for (const std::string& fact : figure.facts) {
        facts.append(facts.empty() ? "" : separator).append(fact);
    }

    const double joint_px = facts.empty() || figure.source.empty() ? 0.0 : width_of(separator);
    const double left_px = width_px - width_of(facts) - joint_px;
    const double room_px = left_px >= least_source_share * width_px ? left_px : width_px;
    std::vector<std::string> lines{typeface.shortened(figure.source, size_px, room_px, Ellipsis::middle)};
    for (const std::string& fact : figure.facts) {
        std::string longer = lines.back();
        longer.append(longer.empty() ? "" : separator).append(fact);
        if (width_of(longer) <= width_px) {
            lines.back() = longer;
        } else {
            lines.push_back(typeface.shortened(fact, size_px, width_px, Ellipsis::end));
        }
    }
    lines.erase(std::remove(lines.begin(), lines.end(), std::string()), lines.end());
    return lines;
}

// Returns the y below the heading.
double draw_heading(Canvas& canvas, const Figure& figure, const Typeface& regular, const Typeface& bold) {
    const double left = figure_edge_px * figure.scale;
    const double width_px = figure.width_px - 2.0 * left;
    double y = figure_edge_px * figure.scale;
    if (!figure.title.empty()) {
        const double size_px = title_px * figure.scale;
        canvas.text(bold, bold.shortened(figure.title, size_px, width_px, Ellipsis::end), {left, y},
                    {size_px, colours::ink, Across::left, Along::top});
        y += 1.35 * size_px;
    }
    for (const std::string& line : fact_lines(figure, regular, width_px)) {
        canvas.text(regular, line, {left, y},
                    {fact_px * figure.scale, colours::muted_ink, Across::left, Along::top});
        y += fact_line_px * figure.scale;
    }
    return y;
}

}  // namespace

Rendering render(const Figure& figure) {
    Rendering rendering;
    rendering.problem = problem_with(figure);
    if (!rendering.ok()) { return rendering; }
    const auto regular = Typeface::open(figure.font_directory + "/DejaVuSans.ttf", rendering.problem);
    if (!regular) { return rendering; }
    const auto bold = Typeface::open(figure.font_directory + "/DejaVuSans-Bold.ttf", rendering.problem);
    if (!bold) { return rendering; }

    Canvas canvas(figure.width_px, figure.height_px);
    const double top = draw_heading(canvas, figure, *regular, *bold) + after_heading_px * figure.scale;
    const std::vector<Box> areas = panel_areas(figure, top);
    std::vector<PanelDrawing> drawings;
    std::vector<Margins> own;
    Margins widest;
    drawings.reserve(figure.panels.size());
    for (std::size_t i = 0; i < areas.size(); ++i) {
        drawings.emplace_back(figure.panels[i], *regular, figure.scale);
        own.push_back(drawings.back().margins(areas[i]));
        if (figure.panels[i].spans_row) { continue; }
        const Margins& margins = own.back();
        widest.left_px = std::max(widest.left_px, margins.left_px);
        widest.right_px = std::max(widest.right_px, margins.right_px);
        widest.top_px = std::max(widest.top_px, margins.top_px);
        widest.bottom_px = std::max(widest.bottom_px, margins.bottom_px);
    }
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        const Margins& margins = figure.panels[i].spans_row ? own[i] : widest;
        rendering.panels.push_back(drawings[i].draw(canvas, areas[i], margins));
    }
    rendering.png = encode_png(canvas.picture());
    rendering.drawing = canvas.drawing();
    return rendering;
}

}  // namespace gyrolog
