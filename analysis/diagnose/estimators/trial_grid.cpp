#include "analysis/diagnose/estimators/trial_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gyrolog {

namespace {

double log_step(const TrialValues& values) { return std::log(values.to / values.from) / (values.count - 1); }

double trial_value(const TrialValues& values, double peak, std::size_t index) {
    const double value = values.count < 2
                             ? values.from
                             : values.from * std::exp(static_cast<double>(index) * log_step(values));
    return values.below_peak ? peak * (1.0 - value) : value;
}

void add_group(TrialPoint point, std::vector<TrialPoint>& points) {
    while (true) {
        for (std::size_t i = 0; i < point.values.size(); ++i) {
            point.params[std::string(point.values[i].param)] =
                trial_value(point.values[i], point.peak, point.index[i]);
        }
        points.push_back(point);
        std::size_t i = point.values.size();
        while (i > 0 && ++point.index[i - 1] == static_cast<std::size_t>(point.values[i - 1].count)) {
            point.index[--i] = 0;
        }
        if (i == 0) { return; }
    }
}

}  // namespace

std::vector<TrialPoint> trial_points(const EffectSignature& signature, std::span<const double> peaks) {
    std::vector<TrialPoint> points;
    std::size_t group = 0;
    for (const std::span<const TrialValues> values : signature.trials) {
        const TrialPoint start{{}, group, std::vector<std::size_t>(values.size(), 0), values, 0.0};
        if (std::ranges::none_of(values, &TrialValues::below_peak)) {
            add_group(start, points);
            ++group;
            continue;
        }
        for (const double peak : peaks) {
            TrialPoint below = start;
            below.group = group++;
            below.peak = peak;
            add_group(std::move(below), points);
        }
    }
    if (points.empty()) { points.push_back({}); }
    return points;
}

double moved_value(const TrialValues& values, double peak, double value, double steps) {
    const double factor = std::exp(steps * log_step(values));
    return values.below_peak ? peak - (peak - value) * factor : value * factor;
}

double step_at(const TrialValues& values, double peak, double value) {
    return (values.below_peak ? peak - value : value) * log_step(values);
}

}  // namespace gyrolog
