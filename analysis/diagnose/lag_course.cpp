#include "analysis/diagnose/lag_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gyrolog {

namespace {

constexpr std::array<const char*, 3> gyro_columns = {"gx", "gy", "gz"};
constexpr double window_s = 1.0;
constexpr int reach = 60;      // of the lags on either side of the course
constexpr int jump_most = 36;  // from a window to the next: three long bursts
constexpr double rel_most = 0.012;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Of following the course: any change will do, but not without a reason.
double change_nats(int change) { return change == 0 ? 0.0 : 4.0 + 0.1 * std::abs(change); }

// Of what changes little within a window.
double drift_variance(const Baseline& baseline, std::size_t axis) {
    double sum = 0.0;
    for (std::size_t i = 0; i < baseline.bins().size(); ++i) {
        if (baseline.bins()[i].f_hz > 0.5 / window_s) { break; }
        sum += baseline.bins()[i].count() * baseline.parts(axis)[i].sum();
    }
    return sum * baseline.rate_hz() / static_cast<double>(baseline.length());
}

}  // namespace

LagCourse::LagCourse(const Baseline& baseline, const Recording& recording)
    : length_(baseline.length()),
      window_slots_(std::max<std::size_t>(16, static_cast<std::size_t>(window_s * baseline.rate_hz()))) {
    const std::int64_t origin = baseline.world().recording().segments.front().first_index;
    present_.assign(length_, false);
    for (const std::size_t axis : baseline.axes()) {
        const Column& column = *recording.find(gyro_columns[axis]);
        Axis measured{std::vector<float>(length_, 0.0F), &baseline.response_rad_s(axis),
                      1.0 / (baseline.parts(axis).back().sum() * baseline.rate_hz()), 0.0};
        measured.drift_rows = 1.0 / (measured.per_variance * drift_variance(baseline, axis));
        double off = 0.0;
        double count = 0.0;
        for (const Segment& segment : recording.segments) {
            for (std::size_t i = 0; i < segment.count; ++i) {
                const auto slot = static_cast<std::size_t>(segment.first_index - origin) + i;
                if (slot >= length_) { break; }
                present_[slot] = true;
                measured.seen[slot] = static_cast<float>(column.value(segment.first + i));
                off += static_cast<double>(measured.seen[slot] - (*measured.expected)[slot]);
                count += 1.0;
            }
        }
        const auto bias = static_cast<float>(off / std::max(1.0, count));
        for (float& rate_rad_s : measured.seen) { rate_rad_s -= bias; }
        axes_.push_back(std::move(measured));
    }
    follow();
}

double LagCourse::misfit_nats(std::size_t begin, std::size_t end, int lag) const {
    const auto last = static_cast<std::int64_t>(length_) - 1;
    double nats = 0.0;
    for (const Axis& axis : axes_) {
        double sum = 0.0;
        double squares = 0.0;
        double count = 0.0;
        double unknown = 0.0;
        for (std::size_t slot = begin; slot < end; ++slot) {
            if (!present_[slot]) { continue; }
            const std::int64_t at = static_cast<std::int64_t>(slot) + lag;
            if (at < 0 || at > last) {
                unknown += 1.0;  // where the motion is not recorded, as good as any
                continue;
            }
            const auto off =
                static_cast<double>(axis.seen[slot] - (*axis.expected)[static_cast<std::size_t>(at)]);
            sum += off;
            squares += off * off;
            count += 1.0;
        }
        if (count > 0.0) {
            nats += 0.5 * axis.per_variance * (squares - sum * sum / (count + axis.drift_rows));
        }
        nats += 0.5 * unknown;
    }
    return nats;
}

void LagCourse::follow() {
    constexpr int states = 2 * reach + 1;
    std::vector<double> score(states, infinity);
    score[reach] = 0.0;
    int centre = 0;
    for (std::size_t begin = 0; begin + window_slots_ / 2 < length_; begin += window_slots_) {
        const std::size_t end = std::min(begin + window_slots_, length_);
        const auto best = std::ranges::min_element(score);
        const int moved = static_cast<int>(best - score.begin()) - reach;
        const double least = *best;
        std::vector<double> next(states, infinity);
        std::vector<double> nats(states);
        for (int j = 0; j < states; ++j) {
            const int from_first = std::max(0, j + moved - jump_most);
            const int from_last = std::min(states - 1, j + moved + jump_most);
            for (int i = from_first; i <= from_last; ++i) {
                const auto place = static_cast<std::size_t>(i);
                next[static_cast<std::size_t>(j)] = std::min(
                    next[static_cast<std::size_t>(j)], score[place] - least + change_nats(j + moved - i));
            }
            nats[static_cast<std::size_t>(j)] = misfit_nats(begin, end, centre + moved + j - reach);
            next[static_cast<std::size_t>(j)] += nats[static_cast<std::size_t>(j)];
        }
        centre += moved;
        score = std::move(next);
        centre_.push_back(centre);
        nats_.push_back(std::move(nats));
    }
}

double LagCourse::nats_at(std::size_t window, double lag) const {
    const std::vector<double>& nats = nats_[window];
    const double place = std::clamp(lag - static_cast<double>(centre_[window] - reach), 0.0, 2.0 * reach);
    const auto middle = static_cast<std::size_t>(
        std::clamp(std::floor(place + 0.5), 1.0, static_cast<double>(nats.size()) - 2.0));
    const double off = place - static_cast<double>(middle);
    const double slope = 0.5 * (nats[middle + 1] - nats[middle - 1]);
    const double curvature = nats[middle + 1] - 2.0 * nats[middle] + nats[middle - 1];
    return nats[middle] + off * (slope + 0.5 * off * curvature);
}

double LagCourse::slope_nats(double rel) const {
    double nats = 0.0;
    for (std::size_t window = 0; window < nats_.size(); ++window) {
        const double middle = (static_cast<double>(window) + 0.5) * static_cast<double>(window_slots_);
        nats += nats_at(window, rel * middle);
    }
    return nats;
}

LagSlope LagCourse::slope() const {
    const double step = 0.25 / static_cast<double>(length_);
    double best = 0.0;
    double least = slope_nats(0.0);
    const int steps = static_cast<int>(rel_most / step);
    for (int i = -steps; i <= steps; ++i) {
        const double nats = slope_nats(i * step);
        if (nats < least) {
            least = nats;
            best = i * step;
        }
    }
    // A parabola through the neighbours, twice.
    double width = step;
    LagSlope slope{best, step};
    for (int round = 0; round < 3; ++round) {
        const double here = slope_nats(slope.rel);
        const double less = slope_nats(slope.rel - width);
        const double more = slope_nats(slope.rel + width);
        const double curvature = less + more - 2.0 * here;
        if (!(curvature > 0.0)) { break; }
        slope.sd = width / std::sqrt(curvature);
        slope.rel += std::clamp(0.5 * (less - more) / curvature, -1.0, 1.0) * width;
        width = std::min(width, slope.sd);
    }
    return slope;
}

std::vector<LagStep> LagCourse::steps() const {
    constexpr int states = 2 * reach + 1;
    const double step_nats = std::log(12.0 * static_cast<double>(length_));
    std::vector<double> score(states, infinity);
    std::vector<std::vector<int>> came_from;  // by window and state: the lag before
    int centre = 0;
    score[reach] = 0.0;
    for (std::size_t window = 0; window < nats_.size(); ++window) {
        std::vector<double> next(states, infinity);
        std::vector<int> from(states, 0);
        for (int j = 0; j < states; ++j) {
            const int lag = centre_[window] - reach + j;
            for (int change = 0; change <= jump_most; ++change) {
                const int i = lag - change - centre + reach;
                if (i < 0 || i >= states) { continue; }
                const double cost = score[static_cast<std::size_t>(i)] + (change == 0 ? 0.0 : step_nats);
                if (cost < next[static_cast<std::size_t>(j)]) {
                    next[static_cast<std::size_t>(j)] = cost;
                    from[static_cast<std::size_t>(j)] = lag - change;
                }
            }
            next[static_cast<std::size_t>(j)] += nats_[window][static_cast<std::size_t>(j)];
        }
        score = std::move(next);
        came_from.push_back(std::move(from));
        centre = centre_[window];
    }
    std::vector<LagStep> steps;
    int lag = centre - reach + static_cast<int>(std::ranges::min_element(score) - score.begin());
    for (std::size_t window = came_from.size(); window-- > 0;) {
        const int before = came_from[window][static_cast<std::size_t>(lag - centre_[window] + reach)];
        if (before != lag) { steps.push_back({refined(window, before, lag), lag - before}); }
        lag = before;
    }
    std::ranges::reverse(steps);
    return steps;
}

// The step was somewhere from the middle of the window before to that of this one's end.
std::size_t LagCourse::refined(std::size_t window, int before, int after) const {
    const std::size_t first = window == 0 ? 0 : (window - 1) * window_slots_;
    const std::size_t last = std::min((window + 1) * window_slots_, length_);
    double nats = 0.0;
    double least = 0.0;
    std::size_t best = first;
    const auto squared = [&](const Axis& axis, std::size_t slot, int lag) {
        const auto at = std::clamp<std::int64_t>(static_cast<std::int64_t>(slot) + lag, 0,
                                                 static_cast<std::int64_t>(length_) - 1);
        const auto off =
            static_cast<double>(axis.seen[slot] - (*axis.expected)[static_cast<std::size_t>(at)]);
        return off * off;
    };
    for (std::size_t slot = first; slot < last; ++slot) {
        if (!present_[slot]) { continue; }
        for (const Axis& axis : axes_) {
            nats += 0.5 * axis.per_variance * (squared(axis, slot, before) - squared(axis, slot, after));
        }
        if (nats < least) {
            least = nats;
            best = slot + 1;
        }
    }
    return best;
}

}  // namespace gyrolog
