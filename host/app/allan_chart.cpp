#include "host/app/allan_chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace gyrolog {
namespace {

constexpr std::size_t margin = 10;  // for the numbers at the left
constexpr std::size_t columns_min = 30;
constexpr std::size_t rows_min = 5;
constexpr std::size_t columns_max = 100;

// A logarithmic scale from cell 0 to the last.
struct LogScale {
    double low = std::numeric_limits<double>::infinity();  // decimal logarithms
    double high = -std::numeric_limits<double>::infinity();
    std::size_t cells = 1;

    void include(double value) {
        low = std::min(low, std::log10(value));
        high = std::max(high, std::log10(value));
    }
    double place(double value) const {
        return (std::log10(value) - low) / std::max(high - low, 1e-9) * static_cast<double>(cells - 1);
    }
    std::size_t cell(double value) const {
        return static_cast<std::size_t>(
            std::clamp(std::lround(place(value)), 0L, static_cast<long>(cells) - 1));
    }
};

using Grid = std::vector<std::string>;

void draw_line(Grid& grid, const LogScale& x, const LogScale& y, const AllanPoint& a, const AllanPoint& b) {
    const std::size_t begin = x.cell(a.tau_s);
    const std::size_t end = x.cell(b.tau_s);
    for (std::size_t column = begin + 1; column < end; ++column) {
        const double part = static_cast<double>(column - begin) / static_cast<double>(end - begin);
        const double height = y.place(a.deviation) + part * (y.place(b.deviation) - y.place(a.deviation));
        char& cell = grid[static_cast<std::size_t>(std::lround(height))][column];
        if (cell == ' ') { cell = '.'; }
    }
}

void draw_curve(Grid& grid, const LogScale& x, const LogScale& y, const AllanCurve& curve, char name) {
    const AllanPoint* previous = nullptr;
    for (const AllanPoint& point : curve.points) {
        if (!(point.deviation > 0.0)) { continue; }
        if (previous != nullptr) { draw_line(grid, x, y, *previous, point); }
        grid[y.cell(point.deviation)][x.cell(point.tau_s)] = name;
        previous = &point;
    }
}

// The powers of ten on the scale of averaging times.
std::string times_row(const LogScale& x) {
    std::string row(margin + x.cells, ' ');
    for (int decade = static_cast<int>(std::ceil(x.low)); decade <= std::floor(x.high); ++decade) {
        const double tau_s = std::pow(10.0, decade);
        const std::string text = fmt::format("{:g}", tau_s);
        const std::size_t at = margin + x.cell(tau_s);
        const bool free = row.find_first_not_of(' ', at > 0 ? at - 1 : at) == std::string::npos;
        if (free && at + text.size() + 2 <= row.size()) { row.replace(at, text.size(), text); }
    }
    row.replace(row.size() - 1, 1, "s");
    return row;
}

}  // namespace

std::vector<std::string> allan_chart(const std::array<const AllanCurve*, 3>& axes, std::size_t columns,
                                     std::size_t rows) {
    columns = std::min(columns, columns_max);
    if (columns < columns_min || rows < rows_min) { return {}; }
    LogScale x;
    LogScale y;
    for (const AllanCurve* curve : axes) {
        for (const AllanPoint& point : curve->points) {
            if (!(point.deviation > 0.0)) { continue; }
            x.include(point.tau_s);
            y.include(point.deviation);
        }
    }
    if (!(x.high >= x.low)) { return {}; }
    x.cells = columns - margin;
    y.cells = rows - 1;
    Grid grid(y.cells, std::string(x.cells, ' '));
    constexpr std::array names{'x', 'y', 'z'};
    for (std::size_t i = axes.size(); i-- > 0;) { draw_curve(grid, x, y, *axes[i], names[i]); }

    std::vector<std::string> lines;
    lines.reserve(rows);
    for (std::size_t row = y.cells; row-- > 0;) {
        const bool first = row + 1 == y.cells;
        const std::string scale = first      ? fmt::format("{:.2g} dps", std::pow(10.0, y.high))
                                  : row == 0 ? fmt::format("{:.2g}", std::pow(10.0, y.low))
                                             : std::string();
        std::string line = fmt::format("{:>{}} {}", scale, margin - 1, grid[row]);
        line.erase(line.find_last_not_of(' ') + 1);
        lines.push_back(std::move(line));
    }
    lines.push_back(times_row(x));
    return lines;
}

}  // namespace gyrolog
