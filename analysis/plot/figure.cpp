#include "analysis/plot/figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "analysis/plot/canvas.hpp"
#include "analysis/plot/panel.hpp"

namespace gyrolog {
namespace {

// At scale 1.
constexpr double edge_px = 26.0;
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

std::vector<double> row_shares(const Figure& figure) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        if (i % columns_of(figure) == 0) { shares.push_back(0.0); }
        shares.back() = std::max(shares.back(), figure.panels[i].height_share);
    }
    return shares;
}

std::string problem_with(const Figure& figure) {
    if (!(figure.scale >= 0.1 && figure.scale <= 20.0)) {
        return "draw a figure of scale " + std::to_string(figure.scale) + ": scales go from 0.1 to 20";
    }
    const std::vector<double> shares = row_shares(figure);
    for (const double share : shares) {
        if (!(share > 0.0)) { return "draw a row of panels of no height"; }
    }
    const double rows = shares.empty() ? 0.0
                                       : std::accumulate(shares.begin(), shares.end(), 0.0) /
                                             *std::min_element(shares.begin(), shares.end());
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
    const double edge = edge_px * figure.scale;
    const double gap_px = between_panels_px * figure.scale;
    const std::vector<double> shares = row_shares(figure);
    const auto rows = static_cast<double>(shares.size());
    const auto columns = static_cast<double>(columns_of(figure));
    const double share_px = (figure.height_px - edge - top - gap_px * (rows - 1.0)) /
                            std::accumulate(shares.begin(), shares.end(), 0.0);
    const double width_px = (figure.width_px - 2.0 * edge - gap_px * (columns - 1.0)) / columns;
    std::vector<Box> areas;
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        const std::size_t row = i / columns_of(figure);
        if (i > 0 && i % columns_of(figure) == 0) { top += share_px * shares[row - 1] + gap_px; }
        const double left = edge + static_cast<double>(i % columns_of(figure)) * (width_px + gap_px);
        areas.push_back({left, top, left + width_px, top + share_px * shares[row]});
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
    const double left = edge_px * figure.scale;
    const double width_px = figure.width_px - 2.0 * left;
    double y = edge_px * figure.scale;
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
    Margins widest;
    drawings.reserve(figure.panels.size());
    for (std::size_t i = 0; i < areas.size(); ++i) {
        drawings.emplace_back(figure.panels[i], *regular, figure.scale);
        const Margins margins = drawings.back().margins(areas[i]);
        widest.left_px = std::max(widest.left_px, margins.left_px);
        widest.right_px = std::max(widest.right_px, margins.right_px);
        widest.top_px = std::max(widest.top_px, margins.top_px);
        widest.bottom_px = std::max(widest.bottom_px, margins.bottom_px);
    }
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        rendering.panels.push_back(drawings[i].draw(canvas, areas[i], widest));
    }
    rendering.png = encode_png(canvas.picture());
    return rendering;
}

}  // namespace gyrolog
