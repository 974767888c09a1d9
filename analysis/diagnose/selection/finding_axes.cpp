#include "analysis/diagnose/selection/finding_axes.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace gyrolog {

std::optional<Finding> on_axes(const Finding& finding, const std::vector<std::size_t>& axes) {
    Finding rest = finding;
    rest.entries.clear();
    rest.sd.clear();
    for (std::size_t i = 0; i < finding.entries.size(); ++i) {
        EffectModel entry = finding.entries[i];
        if (entry.axes.empty()) { return std::nullopt; }
        std::erase_if(entry.axes, [&](const std::string& name) {
            return std::ranges::none_of(axes, [&](std::size_t axis) { return axis_names.at(axis) == name; });
        });
        if (entry.axes.empty()) { continue; }
        rest.entries.push_back(std::move(entry));
        if (i < finding.sd.size()) { rest.sd.push_back(finding.sd[i]); }
    }
    if (rest.entries.empty()) { return std::nullopt; }
    rest.where.axes.clear();
    for (const std::size_t axis : finding.where.axes) {
        if (std::ranges::count(axes, axis) != 0) {
            rest.where.axes.push_back(axis);
            continue;
        }
        rest.gain_nats -= finding.axis_gain_nats.at(axis);
        rest.evidence_nats -= finding.axis_gain_nats.at(axis);
        rest.axis_gain_nats.at(axis) = 0.0;
        rest.axis_spectral_nats.at(axis) = 0.0;
    }
    return rest;
}

std::optional<Finding> on_more_axes(Finding finding, const Finding& more) {
    const auto is_of_single_axes = [](const EffectModel& entry) { return !entry.axes.empty(); };
    if (!std::ranges::all_of(finding.entries, is_of_single_axes) ||
        !std::ranges::all_of(more.entries, is_of_single_axes)) {
        return std::nullopt;
    }
    for (const std::size_t axis : more.where.axes) {
        if (std::ranges::count(finding.where.axes, axis) != 0) { return std::nullopt; }
        finding.where.axes.push_back(axis);
        finding.axis_gain_nats.at(axis) = more.axis_gain_nats.at(axis);
        finding.axis_spectral_nats.at(axis) = more.axis_spectral_nats.at(axis);
    }
    std::ranges::sort(finding.where.axes);
    finding.sd.resize(finding.entries.size());
    finding.entries.insert(finding.entries.end(), more.entries.begin(), more.entries.end());
    finding.sd.insert(finding.sd.end(), more.sd.begin(), more.sd.end());
    finding.parameters += more.parameters;
    finding.gain_nats += more.gain_nats;
    finding.evidence_nats += more.evidence_nats;
    return finding;
}

}  // namespace gyrolog
