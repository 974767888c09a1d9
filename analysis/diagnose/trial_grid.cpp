#include "analysis/diagnose/trial_grid.hpp"

#include <cmath>

namespace gyrolog {

double trial_value(const TrialValues& values, std::size_t index) {
    if (values.count < 2) { return values.from; }
    const double share = static_cast<double>(index) / static_cast<double>(values.count - 1);
    return values.even ? values.from + share * (values.to - values.from)
                       : values.from * std::pow(values.to / values.from, share);
}

std::vector<TrialPoint> trial_points(const EffectSignature& signature) {
    std::vector<TrialPoint> points;
    for (std::size_t group = 0; group < signature.trials.size(); ++group) {
        const std::span<const TrialValues> axes = signature.trials[group];
        TrialPoint point{{}, group, std::vector<std::size_t>(axes.size(), 0)};
        while (true) {
            for (std::size_t i = 0; i < axes.size(); ++i) {
                point.params[std::string(axes[i].param)] = trial_value(axes[i], point.index[i]);
            }
            points.push_back(point);
            std::size_t i = axes.size();
            while (i > 0 && ++point.index[i - 1] == static_cast<std::size_t>(axes[i - 1].count)) {
                point.index[--i] = 0;
            }
            if (i == 0) { break; }
        }
    }
    if (points.empty()) { points.push_back({}); }
    return points;
}

}  // namespace gyrolog
