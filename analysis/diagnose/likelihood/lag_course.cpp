#include "analysis/diagnose/likelihood/lag_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/simulate/effect_axes.hpp"

namespace gyrolog::resolution {

constexpr double window_s = 1.0;
constexpr double quickest_motion_s = 0.08;
constexpr int lags_beside = 60;    // of the lags on either side of the course
constexpr int lag_jump_most = 36;  // from a window to the next: three long bursts
constexpr double slope_most = 0.012;
// Between whole lags the misfit is taken for a parabola: right to so much of a period at the end of the
// record.
constexpr double between_lags = 0.003;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Of following the course: any change will do, but not without a reason.
double change_nats(int change) { return change == 0 ? 0.0 : 8.0 + 0.1 * std::abs(change); }

// Running mean over `width` slots. In a shifted reference its own noise is no longer that of the samples:
// what of it is quicker than any motion would pass for signs of a lag.
std::vector<float> running_mean(const std::vector<float>& values, std::size_t width) {
    std::vector<float> smooth(values.size());
    const std::size_t half = width / 2;
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size() + half; ++i) {
        if (i < values.size()) { sum += static_cast<double>(values[i]); }
        if (i >= width) { sum -= static_cast<double>(values[i - width]); }
        if (i >= half) { smooth[i - half] = static_cast<float>(sum / static_cast<double>(width)); }
    }
    return smooth;
}

// Of what changes little within a window.
double drift_variance(const Prediction& prediction, std::size_t axis) {
    double sum = 0.0;
    for (std::size_t i = 0; i < prediction.bins().size(); ++i) {
        if (prediction.bins()[i].f_hz > 0.5 / resolution::window_s) { break; }
        sum += prediction.bins()[i].count() * prediction.parts(axis)[i].sum();
    }
    return sum * prediction.rate_hz() / static_cast<double>(prediction.length());
}

}  // namespace

LagCourse::LagCourse(const Prediction& prediction, const Recording& recording)
    : length_(prediction.length()),
      window_slots_(
          std::max<std::size_t>(16, static_cast<std::size_t>(resolution::window_s * prediction.rate_hz()))),
      smooth_slots_(std::max<std::size_t>(
          1, static_cast<std::size_t>(resolution::quickest_motion_s * prediction.rate_hz()))),
      stride_(std::max<std::size_t>(1, smooth_slots_ / 2)) {
    const std::int64_t origin = prediction.world().recording().segments.front().first_index;
    present_.assign(length_, false);
    for (const std::size_t axis : prediction.axes()) {
        const Column& column = *recording.find(gyro_columns[axis]);
        Axis measured;
        measured.seen.assign(length_, 0.0F);
        measured.per_variance = 1.0 / (prediction.parts(axis).back().sum() * prediction.rate_hz());
        const std::vector<float>* expected = &prediction.denoised_response_rad_s(axis);
        double off = 0.0;
        double count = 0.0;
        for (const Segment& segment : recording.segments) {
            for (std::size_t i = 0; i < segment.count; ++i) {
                const auto slot = static_cast<std::size_t>(segment.first_index - origin) + i;
                if (slot >= length_) { break; }
                present_[slot] = true;
                measured.seen[slot] = static_cast<float>(column.value(segment.first + i));
                off += static_cast<double>(measured.seen[slot] - (*expected)[slot]);
                count += 1.0;
            }
        }
        const auto bias = static_cast<float>(off / std::max(1.0, count));
        for (std::size_t slot = 0; slot < length_; ++slot) {
            measured.seen[slot] = present_[slot] ? measured.seen[slot] - bias : (*expected)[slot];
        }
        measured.smooth_seen = running_mean(measured.seen, smooth_slots_);
        measured.expected = expected;
        measured.smooth_expected = running_mean(*expected, smooth_slots_);
        axes_.push_back(std::move(measured));
    }
    // While the lag is unknown, so is the bias: first with any constant in each window.
    follow();
    take_bias_off();
    for (std::size_t a = 0; a < axes_.size(); ++a) {
        axes_[a].drift_rows =
            1.0 / (axes_[a].per_variance * drift_variance(prediction, prediction.axes()[a]));
    }
    follow();
}

// As the course that was followed has it.
void LagCourse::take_bias_off() {
    for (Axis& axis : axes_) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t slot = 0; slot < length_; ++slot) {
            if (!present_[slot]) { continue; }
            // A window's centre is the best lag up to the window before.
            const std::size_t window = std::min(slot / window_slots_ + 1, centre_.size() - 1);
            sum += static_cast<double>(axis.seen[slot] - (*axis.expected)[shifted(slot, centre_[window])]);
            count += 1.0;
        }
        const auto bias = static_cast<float>(sum / std::max(1.0, count));
        for (float& rate_rad_s : axis.seen) { rate_rad_s -= bias; }
        for (float& rate_rad_s : axis.smooth_seen) { rate_rad_s -= bias; }
    }
}

// Beyond its ends the motion is held.
std::size_t LagCourse::shifted(std::size_t slot, int lag) const {
    return static_cast<std::size_t>(std::clamp<std::int64_t>(static_cast<std::int64_t>(slot) + lag, 0,
                                                             static_cast<std::int64_t>(length_) - 1));
}

double LagCourse::misfit_nats(std::size_t begin, std::size_t end, int lag) const {
    double nats = 0.0;
    for (const Axis& axis : axes_) {
        double sum = 0.0;
        double squares = 0.0;
        double count = 0.0;
        for (std::size_t slot = begin + stride_ / 2; slot < end; slot += stride_) {
            if (!present_[slot]) { continue; }
            const std::size_t at = shifted(slot, lag);
            const auto off = static_cast<double>(axis.smooth_seen[slot] - axis.smooth_expected[at]);
            sum += off;
            squares += off * off;
            count += 1.0;
        }
        if (count > 0.0) {
            // Each stands for those that were stepped over.
            const auto rows = static_cast<double>(stride_);
            sum *= rows;
            squares *= rows;
            count *= rows;
            nats += 0.5 * axis.per_variance * (squares - sum * sum / (count + axis.drift_rows));
        }
    }
    return nats;
}

void LagCourse::follow() {
    constexpr int states = 2 * resolution::lags_beside + 1;
    centre_.clear();
    nats_.clear();
    std::vector<double> score(states, infinity);
    score[resolution::lags_beside] = 0.0;
    int centre = 0;
    for (std::size_t begin = 0; begin + window_slots_ / 2 < length_; begin += window_slots_) {
        const std::size_t end = std::min(begin + window_slots_, length_);
        const auto best = std::ranges::min_element(score);
        const int moved = static_cast<int>(best - score.begin()) - resolution::lags_beside;
        const double least = *best;
        std::vector<double> next(states, infinity);
        std::vector<double> nats(states, 0.0);
        for (int j = 0; j < states; ++j) {
            const int from_first = std::max(0, j + moved - resolution::lag_jump_most);
            const int from_last = std::min(states - 1, j + moved + resolution::lag_jump_most);
            for (int i = from_first; i <= from_last; ++i) {
                const auto place = static_cast<std::size_t>(i);
                next[static_cast<std::size_t>(j)] = std::min(
                    next[static_cast<std::size_t>(j)], score[place] - least + change_nats(j + moved - i));
            }
            nats[static_cast<std::size_t>(j)] =
                misfit_nats(begin, end, centre + moved + j - resolution::lags_beside);
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
    const double place = std::clamp(lag - static_cast<double>(centre_[window] - resolution::lags_beside), 0.0,
                                    2.0 * resolution::lags_beside);
    const auto middle = static_cast<std::size_t>(
        std::clamp(std::floor(place + 0.5), 1.0, static_cast<double>(nats.size()) - 2.0));
    const double off = place - static_cast<double>(middle);
    const double slope = 0.5 * (nats[middle + 1] - nats[middle - 1]);
    const double curvature = nats[middle + 1] - 2.0 * nats[middle] + nats[middle - 1];
    return nats[middle] + off * (slope + 0.5 * off * curvature);
}

// Of the slots that were looked at; a sample stands for the period after it.
double LagCourse::middle_slot(std::size_t window) const {
    const std::size_t first = window * window_slots_ + stride_ / 2;
    const std::size_t last = first + (window_slots_ - 1 - stride_ / 2) / stride_ * stride_;
    return 0.5 * static_cast<double>(first + last + 1);
}

double LagCourse::slope_nats(double rel) const {
    double nats = 0.0;
    for (std::size_t window = 0; window < nats_.size(); ++window) {
        // At the ends a lag may lead to where the motion was not recorded.
        const std::int64_t at = static_cast<std::int64_t>(window * window_slots_) + centre_[window];
        if (at < resolution::lags_beside ||
            at + static_cast<std::int64_t>(window_slots_) + resolution::lags_beside >
                static_cast<std::int64_t>(length_)) {
            continue;
        }
        nats += nats_at(window, rel * middle_slot(window));
    }
    return nats;
}

LagSlope LagCourse::slope() const {
    const double step = 0.25 / static_cast<double>(length_);
    double best = 0.0;
    double least = slope_nats(0.0);
    const int steps = static_cast<int>(resolution::slope_most / step);
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
    slope.sd = std::hypot(slope.sd, resolution::between_lags / static_cast<double>(length_));
    return slope;
}

std::vector<LagStep> LagCourse::steps() const {
    constexpr int states = 2 * resolution::lags_beside + 1;
    const double change_costs = step_nats();
    std::vector<double> score(states, infinity);
    std::vector<std::vector<int>> came_from;  // by window and state: the lag before
    int centre = 0;
    score[resolution::lags_beside] = 0.0;
    for (std::size_t window = 0; window < nats_.size(); ++window) {
        std::vector<double> next(states, infinity);
        std::vector<int> from(states, 0);
        for (int j = 0; j < states; ++j) {
            const int lag = centre_[window] - resolution::lags_beside + j;
            for (int change = 0; change <= resolution::lag_jump_most; ++change) {
                const int i = lag - change - centre + resolution::lags_beside;
                if (i < 0 || i >= states) { continue; }
                const double cost = score[static_cast<std::size_t>(i)] + (change == 0 ? 0.0 : change_costs);
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
    // No course of rising lags stays within reach of the best one.
    if (!std::isfinite(*std::ranges::min_element(score))) { return {}; }
    std::vector<LagStep> steps;
    int lag =
        centre - resolution::lags_beside + static_cast<int>(std::ranges::min_element(score) - score.begin());
    for (std::size_t window = came_from.size(); window-- > 0;) {
        const int place = lag - centre_[window] + resolution::lags_beside;
        const int before = came_from[window][static_cast<std::size_t>(place)];
        if (before != lag) { steps.push_back({window * window_slots_, lag - before}); }
        lag = before;
    }
    std::ranges::reverse(steps);
    return merged(std::move(steps));
}

double LagCourse::squares_nats(std::size_t slot, int lag) const {
    if (!present_[slot]) { return 0.0; }
    const std::size_t at = shifted(slot, lag);
    double nats = 0.0;
    for (const Axis& axis : axes_) {
        const auto off = static_cast<double>(axis.seen[slot] - (*axis.expected)[at]);
        nats += 0.5 * axis.per_variance * off * off;
    }
    return nats;
}

// From where on the new lag fits best.
std::size_t LagCourse::best_place(std::size_t first, std::size_t last, int before, int after) const {
    std::size_t best = first;
    double least = 0.0;
    double nats = 0.0;
    if (before == after) { return best; }
    for (std::size_t slot = first; slot < last; ++slot) {
        nats += squares_nats(slot, before) - squares_nats(slot, after);
        if (nats < least) {
            least = nats;
            best = slot + 1;
        }
    }
    return best;
}

// A step within a window may have been taken for two at its ends, and of two in one window only their sum is
// sure: every two neighbours are fitted again sample by sample, and become one where two do not pay.
std::vector<LagStep> LagCourse::merged(std::vector<LagStep> steps) const {
    int before = 0;
    for (std::size_t i = 0; i < steps.size();) {
        const std::size_t from = i == 0 ? 0 : steps[i - 1].slot;
        const std::size_t first = std::max(from, steps[i].slot - std::min(steps[i].slot, window_slots_));
        const bool has_next = i + 1 < steps.size() && steps[i + 1].slot < steps[i].slot + 3 * window_slots_;
        const std::size_t next = i + 1 < steps.size() ? steps[i + 1].slot : length_;
        if (!has_next) {
            const std::size_t last = std::min(next, steps[i].slot + window_slots_);
            steps[i].slot = best_place(first, last, before, before + steps[i].samples);
            before += steps[i].samples;
            ++i;
            continue;
        }
        const std::size_t after_next = i + 2 < steps.size() ? steps[i + 2].slot : length_;
        const std::size_t last = std::min(after_next, next + window_slots_);
        const int after = before + steps[i].samples + steps[i + 1].samples;
        const Pair pair = best_pair(first, last, before, after);
        steps[i] = {pair.first_slot, pair.middle - before};
        steps[i + 1] = {pair.second_slot, after - pair.middle};
        if (pair.middle == before || pair.middle == after) {
            steps[i] = {pair.middle == before ? pair.second_slot : pair.first_slot, after - before};
            steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(i) + 1);
            continue;
        }
        before = pair.middle;
        ++i;
    }
    return steps;
}

LagCourse::Pair LagCourse::best_pair(std::size_t first, std::size_t last, int before, int after) const {
    Pair best;
    double least = infinity;
    for (int middle = before; middle <= after; ++middle) {
        const std::size_t one = best_place(first, last, before, middle);
        const std::size_t two = best_place(one, last, middle, after);
        double nats = middle == before || middle == after ? 0.0 : step_nats();
        for (std::size_t slot = first; slot < last; ++slot) {
            nats += squares_nats(slot, slot < one ? before : slot < two ? middle : after);
        }
        if (nats < least) {
            least = nats;
            best = {one, two, middle};
        }
    }
    return best;
}

double LagCourse::step_nats() const { return std::log(12.0 * static_cast<double>(length_)); }

}  // namespace gyrolog
