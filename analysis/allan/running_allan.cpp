#include "analysis/allan/running_allan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/intervals.hpp"

namespace gyrolog {

void RunningAllan::take(std::int64_t signed_index, std::int16_t count) {
    const auto index = static_cast<std::uint64_t>(signed_index);
    if (index != index_) {
        for (Octave& octave : octaves_) { octave.kept = 0; }
        index_ = index;
        take_point();
    }
    theta_ += count;
    ++index_;
    ++samples_;
    take_point();
}

// theta_ is the point before sample `index_`: it belongs to every octave whose stride divides the index.
void RunningAllan::take_point() {
    const auto zeros = static_cast<std::size_t>(std::countr_zero(index_));
    const std::size_t reached = std::min(octaves, zeros + overlap_log2 + 1);
    for (std::size_t j = 0; j < reached; ++j) {
        enter(octaves_[j], theta_, std::size_t{1} << std::min<std::size_t>(j, overlap_log2));
    }
}

// `reach`: m in points of this octave.
void RunningAllan::enter(Octave& octave, std::int64_t theta, std::size_t reach) {
    const auto back = [&](std::size_t points) {
        const std::size_t at = octave.next + points_kept - points;
        return octave.theta[at >= points_kept ? at - points_kept : at];
    };
    if (octave.kept >= 2 * reach) {
        const auto difference = static_cast<double>(theta - 2 * back(reach) + back(2 * reach));
        const double square = difference * difference;
        const double sum = octave.squares + square;
        octave.squares_lost +=
            octave.squares >= square ? (octave.squares - sum) + square : (square - sum) + octave.squares;
        octave.squares = sum;
        ++octave.terms;
    }
    octave.theta[octave.next] = theta;
    octave.next = octave.next + 1 == points_kept ? 0 : octave.next + 1;
    octave.kept = std::min(octave.kept + 1, points_kept);
}

std::vector<AllanPoint> RunningAllan::points(double rate_hz) const {
    std::vector<AllanPoint> points;
    points.reserve(octaves);
    for (std::size_t j = 0; j < octaves; ++j) {
        const Octave& octave = octaves_[j];
        if (octave.terms == 0) { continue; }
        AllanPoint point;
        point.m = std::int64_t{1} << j;
        const auto m = static_cast<double>(point.m);
        point.tau_s = m / rate_hz;
        point.terms = octave.terms;
        point.deviation = std::sqrt((octave.squares + octave.squares_lost) /
                                    (2.0 * m * m * static_cast<double>(octave.terms)));
        points.push_back(point);
    }
    return points;
}

RunningAllan::Described RunningAllan::describe(double rate_hz, double scale, double confidence) const {
    Described described;
    AllanCurve& curve = described.curve;
    curve.confidence = confidence;
    curve.points = points(rate_hz);
    for (AllanPoint& point : curve.points) { point.deviation *= scale; }
    const std::array whole{Segment{0, static_cast<std::size_t>(samples_), 0}};
    described.laws = fit_power_laws(curve.points, whole, curve.convention);
    const DeviationRule& rule = rule_of(curve.kind);
    set_intervals(curve, whole,
                  [&](const AllanPoint& point) { return described.laws.shares(rule, point.m); });
    return described;
}

}  // namespace gyrolog
