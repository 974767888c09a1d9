#include "analysis/plot/trace_look.hpp"

#include <algorithm>
#include <cstddef>

namespace gyrolog {
namespace {

constexpr std::array<Marker, 6> markers{Marker::circle,  Marker::square,        Marker::triangle,
                                        Marker::diamond, Marker::triangle_down, Marker::hexagon};

constexpr std::size_t most_told_apart = colours::cycle.size();

const std::string& group_name(const AllanTrace& trace, bool are_many) {
    return are_many && !trace.group.empty() ? trace.group : trace.name;
}

}  // namespace

std::vector<TraceGroup> groups_of(const std::vector<AllanTrace>& traces) {
    const bool are_many = traces.size() > most_told_apart;
    std::vector<TraceGroup> groups;
    for (const AllanTrace& trace : traces) {
        const std::string& name = group_name(trace, are_many);
        auto group = std::find_if(groups.begin(), groups.end(),
                                  [&](const TraceGroup& other) { return other.name == name; });
        // Alone, two of the same name are still two.
        if (!are_many || group == groups.end()) { group = groups.insert(groups.end(), {name, {}}); }
        group->traces.push_back(&trace);
    }
    return groups;
}

std::vector<TraceLook> passes_of(const std::vector<AllanTrace>& traces) {
    const bool are_many = traces.size() > most_told_apart;
    const std::vector<TraceGroup> groups = groups_of(traces);
    std::vector<TraceLook> looks;
    for (const AllanTrace& trace : traces) {
        const auto group = std::find_if(groups.begin(), groups.end(), [&](const TraceGroup& candidate) {
            return std::find(candidate.traces.begin(), candidate.traces.end(), &trace) !=
                   candidate.traces.end();
        });
        const auto i = static_cast<std::size_t>(group - groups.begin()) % most_told_apart;
        TraceLook look{colours::cycle.at(i), markers.at(i)};
        if (are_many) { look = {look.colour, Marker::none, 1.3, true}; }
        looks.push_back(look);
    }
    return looks;
}

}  // namespace gyrolog
