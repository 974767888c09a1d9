#include "host/fleet/fleet_recording.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

namespace gyrolog {
namespace {

namespace fs = std::filesystem;

constexpr std::array commands_by_rank{"analyze", "check", "diagnose", "compare"};

std::size_t rank_of(const std::string& command) {
    return static_cast<std::size_t>(std::ranges::find(commands_by_rank, command) - commands_by_rank.begin());
}

std::string normal(const std::string& file) { return fs::path(file).lexically_normal().string(); }

template <typename Value>
void take(std::optional<Value>& to, const std::optional<Value>& from) {
    if (!to) { to = from; }
}

void take(std::string& to, const std::string& from) {
    if (to.empty()) { to = from; }
}

void take_axes(std::vector<FleetAxis>& to, const std::vector<FleetAxis>& from) {
    for (const FleetAxis& axis : from) {
        const auto same = std::ranges::find_if(
            to, [&](const FleetAxis& one) { return one.sensor == axis.sensor && one.axis == axis.axis; });
        if (same == to.end()) {
            to.push_back(axis);
        } else {
            take(same->comparison, axis.comparison);
        }
    }
}

// What `from` knows and `to` does not.
void take(FleetLine& to, const FleetLine& from, int (*worst)(int, int)) {
    take(to.board, from.board);
    take(to.started, from.started);
    take(to.rate_hz, from.rate_hz);
    take(to.duration_s, from.duration_s);
    take(to.samples, from.samples);
    take(to.missing, from.missing);
    take(to.temperature_C, from.temperature_C);
    take(to.end, from.end);
    take_axes(to.axes, from.axes);
    take(to.verdict, from.verdict);
    if (to.causes.empty()) { to.causes = from.causes; }
    take(to.gap_before, from.gap_before);
    take(to.gap_named, from.gap_named);
    take(to.gap_after, from.gap_after);
    take(to.seed, from.seed);
    take(to.version, from.version);
    if (to.exit && from.exit) { to.exit = worst(*to.exit, *from.exit); }
    take(to.exit, from.exit);
    if (from.seconds) { to.seconds = to.seconds.value_or(0.0) + *from.seconds; }
    if (from.error.empty() || from.error == to.error) { return; }
    to.error += (to.error.empty() ? "" : "; ") + from.error;
}

struct Answers {
    std::string file;                                 // as it came first
    std::map<std::size_t, const FleetLine*> by_rank;  // of its commands, the last each
};

FleetLine joined(const Answers& answers, int (*worst)(int, int)) {
    FleetLine recording;
    for (const auto& [rank, line] : answers.by_rank) { take(recording, *line, worst); }
    recording.file = answers.file;
    return recording;
}

}  // namespace

FleetRecordings join_lines(std::span<const FleetLine> lines, std::span<const std::string> expected,
                           int (*worst)(int, int)) {
    std::vector<Answers> all;
    std::map<std::string, std::size_t> place;
    std::set<std::string> names;
    for (const FleetLine& line : lines) {
        const auto [found, is_new] = place.try_emplace(normal(line.file), all.size());
        if (is_new) {
            all.push_back({line.file, {}});
            names.insert(fs::path(line.file).filename().string());
        }
        all[found->second].by_rank[rank_of(line.command)] = &line;
    }
    FleetRecordings answer;
    answer.recordings.reserve(all.size() + expected.size());
    for (const Answers& one : all) { answer.recordings.push_back(joined(one, worst)); }
    for (const std::string& name : expected) {
        const bool is_bare = name.find('/') == std::string::npos;
        if (place.contains(normal(name)) || (is_bare && names.contains(name))) { continue; }
        place.emplace(normal(name), all.size());  // listed twice, it is one
        FleetLine& lacking = answer.recordings.emplace_back();
        lacking.file = name;
        lacking.error = "no answer";
        answer.unanswered.push_back(name);
    }
    return answer;
}

}  // namespace gyrolog
