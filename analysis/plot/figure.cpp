#include "analysis/plot/figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "analysis/plot/canvas.hpp"
#include "analysis/plot/legend.hpp"
#include "analysis/plot/panel.hpp"
#include "analysis/plot/paper_size.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double figure_edge_px = 14.0;
constexpr double title_px = 26.0;
constexpr double fact_line_px = 27.0;
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
    const double least_width_px = least_panel_px * static_cast<double>(columns_of(figure)) * figure.scale;
    const double least_height_px = (110.0 + 170.0 * rows) * figure.scale;
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

// Where the panels lie from top to bottom.
struct Width {
    double top;
    double bottom;
};

std::vector<Box> panel_areas(const Figure& figure, Width span, const std::vector<double>& widths_px) {
    const double edge = figure_edge_px * figure.scale;
    const double gap_px = between_panels_px * figure.scale;
    const std::vector<PanelRow> rows = rows_of(figure);
    double shares = 0.0;
    for (const PanelRow& row : rows) { shares += row.share; }
    const double share_px =
        (span.bottom - span.top - gap_px * (static_cast<double>(rows.size()) - 1.0)) / shares;
    std::vector<Box> areas;
    double top = span.top;
    for (const PanelRow& row : rows) {
        double left = edge;
        for (std::size_t column = 0; column < row.panels.size(); ++column) {
            const double right = row.is_spanned ? figure.width_px - edge : left + widths_px[column];
            areas.push_back({left, top, right, top + share_px * row.share});
            left = right + gap_px;
        }
        top += share_px * row.share + gap_px;
    }
    return areas;
}

// Of the panels that do not span their row: at the sides the widest of each column, above and below the
// widest of each row.
std::vector<Margins> shared_margins(const Figure& figure, std::vector<Margins> margins) {
    std::vector<Margins> columns(columns_of(figure));
    for (const PanelRow& row : rows_of(figure)) {
        if (row.is_spanned) { continue; }
        Margins all;
        for (std::size_t column = 0; column < row.panels.size(); ++column) {
            const Margins& own = margins[row.panels[column]];
            columns[column].left_px = std::max(columns[column].left_px, own.left_px);
            columns[column].right_px = std::max(columns[column].right_px, own.right_px);
            all.top_px = std::max(all.top_px, own.top_px);
            all.bottom_px = std::max(all.bottom_px, own.bottom_px);
        }
        for (const std::size_t panel : row.panels) {
            margins[panel].top_px = all.top_px;
            margins[panel].bottom_px = all.bottom_px;
        }
    }
    for (const PanelRow& row : rows_of(figure)) {
        if (row.is_spanned) { continue; }
        for (std::size_t column = 0; column < row.panels.size(); ++column) {
            margins[row.panels[column]].left_px = columns[column].left_px;
            margins[row.panels[column]].right_px = columns[column].right_px;
        }
    }
    return margins;
}

// So wide that within these margins all plots of a row are equally wide.
std::vector<double> column_widths_px(const Figure& figure, const std::vector<Margins>& margins) {
    std::vector<double> widths_px(columns_of(figure), 0.0);
    for (const PanelRow& row : rows_of(figure)) {
        if (row.is_spanned) { continue; }
        for (std::size_t column = 0; column < row.panels.size(); ++column) {
            const Margins& own = margins[row.panels[column]];
            widths_px[column] = own.left_px + own.right_px;
        }
    }
    const auto count = static_cast<double>(widths_px.size());
    double plots_px = figure.width_px - 2.0 * figure_edge_px * figure.scale -
                      (count - 1.0) * between_panels_px * figure.scale;
    for (const double beside_px : widths_px) { plots_px -= beside_px; }
    for (double& width_px : widths_px) { width_px += plots_px / count; }
    return widths_px;
}

std::vector<PanelDrawing> drawings_of(const Figure& figure, const Typeface& typeface) {
    std::vector<PanelDrawing> drawings;
    drawings.reserve(figure.panels.size());
    for (const Panel& panel : figure.panels) { drawings.emplace_back(panel, typeface, figure.scale); }
    return drawings;
}

std::vector<Margins> margins_in(const std::vector<Box>& areas, const std::vector<PanelDrawing>& drawings) {
    std::vector<Margins> margins;
    for (std::size_t i = 0; i < drawings.size(); ++i) { margins.push_back(drawings[i].margins(areas[i])); }
    return margins;
}

// What the margins need depends on the areas, and the areas on the margins: after two rounds they agree.
std::vector<PanelPlace> draw_panels(Canvas& canvas, const Figure& figure, const Typeface& typeface,
                                    Width span) {
    const std::vector<PanelDrawing> drawings = drawings_of(figure, typeface);
    std::vector<Margins> margins(drawings.size());
    std::vector<Box> areas = panel_areas(figure, span, column_widths_px(figure, margins));
    for (int round = 0; round < 2; ++round) {
        margins = shared_margins(figure, margins_in(areas, drawings));
        areas = panel_areas(figure, span, column_widths_px(figure, margins));
    }
    std::vector<PanelPlace> places;
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        places.push_back(drawings[i].draw(canvas, areas[i], margins[i]));
    }
    return places;
}

// Broken between words; a word that is too long is shortened.
std::vector<std::string> wrapped(const Typeface& typeface, const std::string& text, double size_px,
                                 double width_px) {
    std::vector<std::string> lines;
    std::size_t start = 0;
    while (start < text.size()) {
        std::size_t end = text.size();
        const auto is_long = [&] {
            return typeface.measure(text.substr(start, end - start), size_px).width_px > width_px;
        };
        while (is_long()) {
            const std::size_t blank = text.rfind(' ', end - 1);
            if (blank == std::string::npos || blank <= start) { break; }
            end = blank;
        }
        lines.push_back(
            typeface.shortened(text.substr(start, end - start), size_px, width_px, Ellipsis::end));
        start = end + 1;
    }
    return lines;
}

// Source and facts in as few lines as hold them. The source gets what the facts leave of the first line.
std::vector<std::string> fact_lines(const Figure& figure, const Typeface& typeface, double width_px) {
    const double size_px = letter_px * figure.scale;
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
            for (std::string& line : wrapped(typeface, fact, size_px, width_px)) {
                lines.push_back(std::move(line));
            }
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
        for (const std::string& line : wrapped(bold, figure.title, size_px, width_px)) {
            canvas.text(bold, line, {left, y}, {size_px, colours::ink, Across::left, Along::top});
            y += 1.35 * size_px;
        }
    }
    for (const std::string& line : fact_lines(figure, regular, width_px)) {
        canvas.text(regular, line, {left, y},
                    {letter_px * figure.scale, colours::muted_ink, Across::left, Along::top});
        y += fact_line_px * figure.scale;
    }
    return y;
}

// In the middle at the lower edge.
std::optional<Box> draw_key(Canvas& canvas, const Figure& figure, const Typeface& typeface) {
    if (figure.key.empty()) { return std::nullopt; }
    const double edge_px = figure_edge_px * figure.scale;
    Panel panel;
    panel.curves = figure.key;
    const Legend legend = Legend::in_lines(panel, typeface, figure.scale, figure.width_px - 2.0 * edge_px);
    const Size size = legend.size();
    const double left = (figure.width_px - size.width_px) / 2.0;
    const double bottom = figure.height_px - edge_px;
    const Box box{left, bottom - size.height_px, left + size.width_px, bottom};
    legend.draw(canvas, box);
    return box;
}

}  // namespace

void share_titles(std::vector<Panel>& panels, std::size_t columns) {
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const std::size_t first = i - i % columns;
        if (i != first && panels[i].y.title == panels[first].y.title) { panels[i].y.title.clear(); }
    }
}

Rendering render(const Figure& figure) {
    Rendering rendering;
    rendering.problem = problem_with(figure);
    if (!rendering.ok()) { return rendering; }
    const auto regular = Typeface::open(figure.font_directory + "/DejaVuSans.ttf", rendering.problem);
    if (!regular) { return rendering; }
    const auto bold = Typeface::open(figure.font_directory + "/DejaVuSans-Bold.ttf", rendering.problem);
    if (!bold) { return rendering; }

    Canvas canvas(figure.width_px, figure.height_px, figure.scale * dpi_of_scale_1);
    const double top = draw_heading(canvas, figure, *regular, *bold) + after_heading_px * figure.scale;
    rendering.key = draw_key(canvas, figure, *regular);
    const double bottom = rendering.key ? rendering.key->top - between_panels_px * figure.scale
                                        : figure.height_px - figure_edge_px * figure.scale;
    rendering.panels = draw_panels(canvas, figure, *regular, {top, bottom});
    rendering.png = encode_png(canvas.picture(), canvas.drawing().dpi);
    rendering.drawing = canvas.drawing();
    return rendering;
}

}  // namespace gyrolog
