#include "analysis/recording/grid.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace gyrolog {
namespace {

constexpr std::size_t level_rows = 7;
constexpr double samples_max = 1e11;  // three years at 1 kHz

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::string text_of(double value) {
    std::array<char, 32> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 4).ptr;
    return {text.data(), end};
}

// The mean of the steps near the median step: unlike the median it is no multiple of the stamps' resolution.
double typical_step_s(std::span<const double> t_s) {
    std::vector<double> steps_s;
    steps_s.reserve(t_s.size() - 1);
    for (std::size_t i = 1; i < t_s.size(); ++i) { steps_s.push_back(t_s[i] - t_s[i - 1]); }
    const double middle_s = median(steps_s);
    double sum_s = 0.0;
    std::size_t count = 0;
    for (const double step_s : steps_s) {
        if (step_s > 0.5 * middle_s && step_s < 1.5 * middle_s) {
            sum_s += step_s;
            ++count;
        }
    }
    return count == 0 ? middle_s : sum_s / static_cast<double>(count);
}

bool steps_are_whole_periods(std::span<const double> t_s, double period_s, const GridOptions& options) {
    if (period_s <= 0.0) { return false; }
    std::size_t near = 0;
    double counted_s = 0.0;
    double stretch_begin_s = t_s.front();
    for (std::size_t i = 1; i < t_s.size(); ++i) {
        const double step_s = t_s[i] - t_s[i - 1];
        const double periods = step_s / period_s;
        const double off = std::abs(periods - std::max(1.0, std::round(periods)));
        const bool is_long = periods >= options.dropout_periods;
        if (is_long ? off < 0.2 : off < 0.5) { ++near; }
        // After a stretch that no buffer holds, a long step is a hole, however long.
        const bool is_hole = is_long && t_s[i - 1] - stretch_begin_s > options.burst_longest_s;
        counted_s += is_hole ? period_s : step_s;
        if (is_long) { stretch_begin_s = t_s[i]; }
    }
    const double steps = static_cast<double>(t_s.size() - 1);
    // Bursts can hit whole multiples of their inner step by chance, but then most of the record would be
    // missing.
    const double mean_periods = counted_s / (steps * period_s);
    return static_cast<double>(near) >= 0.9 * steps && mean_periods < 2.0;
}

// Rows where a step exceeds 1.5 periods, and how many samples are missing there. The levels of the stamps
// before and after are compared, not the step itself: one late stamp makes a long step followed by short
// ones.
struct Jump {
    std::size_t row = 0;  // first row after
    std::int64_t missing = 0;
};

std::vector<Jump> find_jumps(std::span<const double> t_s, double period_s, const GridOptions& options) {
    std::vector<std::size_t> candidates;
    for (std::size_t i = 1; i < t_s.size(); ++i) {
        if (t_s[i] - t_s[i - 1] > options.dropout_periods * period_s) { candidates.push_back(i); }
    }
    // Median over rows [begin, end) of how far the stamps run ahead of one period a row.
    const auto level_s = [&](std::size_t begin, std::size_t end, std::size_t origin) {
        std::vector<double> ahead_s;
        for (std::size_t i = begin; i < end; ++i) {
            ahead_s.push_back(t_s[i] - t_s[origin] -
                              period_s * (static_cast<double>(i) - static_cast<double>(origin)));
        }
        return median(std::move(ahead_s));
    };
    std::vector<Jump> jumps;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        const std::size_t row = candidates[c];
        const std::size_t previous = c == 0 ? 0 : candidates[c - 1];
        const std::size_t next = c + 1 == candidates.size() ? t_s.size() : candidates[c + 1];
        const double before_s = level_s(row - std::min(row - previous, level_rows), row, row);
        const double after_s = level_s(row, std::min(next, row + level_rows), row);
        const auto missing = static_cast<std::int64_t>(std::llround((after_s - before_s) / period_s));
        if (missing > 0) { jumps.push_back({row, missing}); }
    }
    return jumps;
}

struct Line {
    double offset_s = 0.0;
    double period_s = 0.0;
    double period_sd_s = 0.0;
};

// A robust line of stamp over grid index: medians of up to 256 blocks, then weighted least squares that lets
// blocks far from the line (a stall of the host) count less (Huber's weights).
Line fit_line(std::span<const double> t_s, std::span<const double> index, double period_s) {
    const std::size_t blocks = std::clamp<std::size_t>(t_s.size() / 16, 2, 256);
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t b = 0; b < blocks; ++b) {
        const std::size_t begin = b * t_s.size() / blocks;
        const std::size_t end = (b + 1) * t_s.size() / blocks;
        std::vector<double> ahead_s;
        double sum_x = 0.0;
        for (std::size_t i = begin; i < end; ++i) {
            ahead_s.push_back(t_s[i] - t_s[0] - period_s * index[i]);
            sum_x += index[i];
        }
        x.push_back(sum_x / static_cast<double>(end - begin));
        // With two or three stamps in all, a block median would be one of its stamps at the mean index of
        // both.
        if (t_s.size() < 64) {
            double sum_y = 0.0;
            for (const double ahead : ahead_s) { sum_y += ahead; }
            y.push_back(sum_y / static_cast<double>(ahead_s.size()));
        } else {
            y.push_back(median(std::move(ahead_s)));
        }
    }
    std::vector<double> weight(blocks, 1.0);
    double slope = 0.0;
    double offset = 0.0;
    double slope_variance = 0.0;
    for (int pass = 0; pass < 8; ++pass) {
        double sw = 0.0;
        double swx = 0.0;
        double swy = 0.0;
        for (std::size_t b = 0; b < blocks; ++b) {
            sw += weight[b];
            swx += weight[b] * x[b];
            swy += weight[b] * y[b];
        }
        double sxx = 0.0;
        double sxy = 0.0;
        for (std::size_t b = 0; b < blocks; ++b) {
            sxx += weight[b] * (x[b] - swx / sw) * (x[b] - swx / sw);
            sxy += weight[b] * (x[b] - swx / sw) * (y[b] - swy / sw);
        }
        slope = sxy / sxx;
        offset = swy / sw - slope * swx / sw;
        std::vector<double> residual(blocks);
        std::vector<double> magnitude(blocks);
        double squares = 0.0;
        double neighbours = 0.0;
        for (std::size_t b = 0; b < blocks; ++b) {
            residual[b] = y[b] - offset - slope * x[b];
            magnitude[b] = std::abs(residual[b]);
            squares += weight[b] * residual[b] * residual[b];
            if (b > 0) { neighbours += std::sqrt(weight[b] * weight[b - 1]) * residual[b] * residual[b - 1]; }
        }
        // Neighbouring blocks share the clock's wander: a positive correlation means fewer independent
        // blocks.
        const double correlation = squares > 0.0 ? std::clamp(neighbours / squares, 0.0, 0.9) : 0.0;
        const double degrees = static_cast<double>(blocks > 2 ? blocks - 2 : 1);
        slope_variance = squares / degrees / sxx * (1.0 + correlation) / (1.0 - correlation);
        const double bound = 1.345 * 1.4826 * median(magnitude);
        for (std::size_t b = 0; b < blocks; ++b) {
            weight[b] = magnitude[b] > bound && bound > 0.0 ? bound / magnitude[b] : 1.0;
        }
    }
    return {t_s[0] + offset, period_s + slope, std::sqrt(slope_variance)};
}

void set_line(Grid& grid, std::span<const double> t_s, std::span<const double> index, double period_s) {
    const Line line = fit_line(t_s, index, period_s);
    grid.rate_hz = 1.0 / line.period_s;
    if (t_s.size() > 2) { grid.rate_sd_hz = line.period_sd_s / (line.period_s * line.period_s); }
    std::vector<double> residual_s(t_s.size());
    for (std::size_t i = 0; i < t_s.size(); ++i) {
        residual_s[i] = t_s[i] - line.offset_s - line.period_s * index[i];
    }
    const double centre_s = median(residual_s);
    for (double& r : residual_s) { r = std::abs(r - centre_s); }
    grid.stamp_jitter_s = 1.4826 * median(std::move(residual_s));
}

void use_as_sampling(Grid& grid, std::span<const double> t_s, double period_s, const GridOptions& options) {
    grid.stamps = StampKind::sampling;
    const std::vector<Jump> jumps = find_jumps(t_s, period_s, options);
    std::vector<double> index(t_s.size());
    std::int64_t missing = 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < t_s.size(); ++i) {
        if (next < jumps.size() && jumps[next].row == i) {
            grid.segments.back().count = i - grid.segments.back().first;
            missing += jumps[next].missing;
            ++next;
            grid.segments.push_back({i, 0, static_cast<std::int64_t>(i) + missing});
        } else if (i == 0) {
            grid.segments.push_back({0, 0, 0});
        }
        index[i] = static_cast<double>(static_cast<std::int64_t>(i) + missing);
    }
    grid.segments.back().count = t_s.size() - grid.segments.back().first;
    set_line(grid, t_s, index, period_s);
    for (const Jump& jump : jumps) {
        const double first_missing = index[jump.row] - static_cast<double>(jump.missing);
        grid.dropouts.push_back({first_missing / grid.rate_hz, jump.missing, "time_stamps"});
    }
}

void use_as_arrival(Grid& grid, std::span<const double> t_s) {
    grid.stamps = StampKind::arrival;
    std::vector<double> index(t_s.size());
    for (std::size_t i = 0; i < t_s.size(); ++i) { index[i] = static_cast<double>(i); }
    grid.segments = {{0, t_s.size(), 0}};
    set_line(grid, t_s, index, (t_s.back() - t_s.front()) / static_cast<double>(t_s.size() - 1));
    grid.warnings.push_back("the time stamps are arrival times (they scatter by " +
                            text_of(*grid.stamp_jitter_s * 1e3) + " ms about a period of " +
                            text_of(1e3 / grid.rate_hz) +
                            " ms): only the mean rate is taken from them, and lost samples cannot be seen");
}

// Stamps that rise from first to last can still fall in between.
void require_a_rate(Grid& grid) {
    if (!(grid.rate_hz > 0.0) || !std::isfinite(grid.rate_hz)) {
        grid = Grid();
        grid.failure = "the time stamps follow no line: give the rate";
    }
}

}  // namespace

Grid grid_from_stamps(std::span<const double> t_s, const GridOptions& options) {
    Grid grid;
    if (t_s.size() < 2) {
        grid.failure = "fewer than two time stamps: the rate is unknown";
        return grid;
    }
    std::size_t not_after = 0;
    for (std::size_t i = 1; i < t_s.size(); ++i) {
        const double step_s = t_s[i] - t_s[i - 1];
        if (step_s <= -options.clock_set_back_s) {
            grid.failure = "the time stamps step back by " + text_of(-step_s) + " s at row " +
                           std::to_string(i + 1) + ": cut the recording there, or give the rate";
            return grid;
        }
        if (!(step_s > 0.0)) { ++not_after; }
    }
    if (!(t_s.back() > t_s.front())) {
        grid.failure = "the time stamps do not rise: the rate is unknown";
        return grid;
    }
    const double period_s = typical_step_s(t_s);
    if (not_after == 0 && steps_are_whole_periods(t_s, period_s, options)) {
        if (!((t_s.back() - t_s.front()) / period_s < samples_max)) {
            grid.failure = "the time stamps jump by years: cut the recording there, or give the rate";
            return grid;
        }
        use_as_sampling(grid, t_s, period_s, options);
        require_a_rate(grid);
        return grid;
    }
    if (not_after > 0) {
        grid.warnings.push_back(std::to_string(not_after) + " of " + std::to_string(t_s.size()) +
                                " time stamps repeat or step back");
    }
    use_as_arrival(grid, t_s);
    require_a_rate(grid);
    return grid;
}

Grid grid_from_rate(std::size_t rows, double rate_hz) {
    Grid grid;
    grid.rate_hz = rate_hz;
    grid.segments = {{0, rows, 0}};
    return grid;
}

void punch_holes(Grid& grid, const std::vector<bool>& present) {
    std::vector<Segment> kept;
    std::size_t row = 0;  // among the rows that stay
    for (const Segment& segment : grid.segments) {
        bool open = false;
        for (std::size_t i = 0; i < segment.count; ++i) {
            if (!present[segment.first + i]) {
                open = false;
                continue;
            }
            if (!open) { kept.push_back({row, 0, segment.first_index + static_cast<std::int64_t>(i)}); }
            ++kept.back().count;
            ++row;
            open = true;
        }
    }
    // A hole that was there before keeps its cause and takes in the rows that went beside it; one at either
    // end of the record is no hole.
    std::vector<Dropout> dropouts;
    for (std::size_t k = 1; k < kept.size(); ++k) {
        const std::int64_t begin = kept[k - 1].first_index + static_cast<std::int64_t>(kept[k - 1].count);
        const std::int64_t missing = kept[k].first_index - begin;
        if (missing == 0) { continue; }
        const double at_s = static_cast<double>(begin - kept.front().first_index) / grid.rate_hz;
        const double end_s = at_s + static_cast<double>(missing) / grid.rate_hz;
        std::string cause = "empty_fields";
        for (const Dropout& old : grid.dropouts) {
            if (old.at_s > at_s - 0.5 / grid.rate_hz && old.at_s < end_s) { cause = old.cause; }
        }
        dropouts.push_back({at_s, missing, std::move(cause)});
    }
    grid.segments = std::move(kept);
    grid.dropouts = std::move(dropouts);
}

}  // namespace gyrolog
