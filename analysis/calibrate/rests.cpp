#include "analysis/calibrate/rests.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "analysis/recording/still_runs.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t parts_of_a_rest = 8;

std::vector<Segment> runs_of(const InertialSignals& signals, const RestOptions& options) {
    std::vector<std::vector<double>> tracks;
    for (const VectorTrack* track : {&signals.rate_rad_s, &signals.force_m_s2}) {
        if (!(*track)[0].empty()) { tracks.insert(tracks.end(), track->begin(), track->end()); }
    }
    if (tracks.empty() || signals.recording.rows() == 0) { return {}; }
    StillRunOptions runs;
    runs.block_s = options.block_s;
    runs.blocks_least = options.blocks_least;
    return still_runs(signals.recording, tracks, runs);
}

bool tilts(const InertialSignals& signals, const Segment& run, const RestOptions& options) {
    if (!signals.has_force()) { return false; }
    const std::size_t quarter = std::max<std::size_t>(1, run.count / 4);
    const Vector3 first = mean_of(signals.force_m_s2, run.first, quarter);
    const Vector3 last = mean_of(signals.force_m_s2, run.first + run.count - quarter, quarter);
    const double apart_s = static_cast<double>(run.count - quarter) * signals.row_s();
    return angle_rad(first, last) > options.tilt_most_rad * std::max(1.0, apart_s / options.tilt_s);
}

bool reference_turns(const InertialSignals& signals, const Segment& run, double most_rad_s) {
    return signals.has_reference() &&
           norm(mean_of(signals.reference_rad_s, run.first, run.count)) > most_rad_s;
}

Rest rest_of(const InertialSignals& signals, std::size_t recording, const Segment& run) {
    Rest rest;
    rest.recording = recording;
    rest.first = run.first;
    rest.rows = run.count;
    const std::int64_t index = run.first_index - signals.recording.segments.front().first_index;
    rest.from_s = static_cast<double>(index) * signals.row_s();
    rest.duration_s = static_cast<double>(run.count) * signals.row_s();
    if (signals.has_force()) { rest.force_m_s2 = mean_of(signals.force_m_s2, run.first, run.count); }
    if (signals.has_rate()) { rest.rate_rad_s = mean_of(signals.rate_rad_s, run.first, run.count); }
    if (signals.has_temperature()) {
        rest.temperature_C = mean_of(signals.temperature_C, run.first, run.count);
    }
    return rest;
}

void drop_constant_rates(std::vector<Rest>& rests, double most_rad_s) {
    if (rests.empty()) { return; }
    const Vector3 slowest = std::ranges::min_element(rests, {}, [](const Rest& rest) {
                                return norm(rest.rate_rad_s);
                            })->rate_rad_s;
    std::erase_if(rests,
                  [&](const Rest& rest) { return norm(difference(rest.rate_rad_s, slowest)) > most_rad_s; });
}

// The squares of the parts' means about the rest's, times the seconds of a part.
void add_scatter(const VectorTrack& track, const Rest& rest, double row_s, Vector3& sums) {
    const std::size_t rows = rest.rows / parts_of_a_rest;
    for (std::size_t axis = 0; axis < sums.size(); ++axis) {
        const double mean = mean_of(track[axis], rest.first, rows * parts_of_a_rest);
        for (std::size_t part = 0; part < parts_of_a_rest; ++part) {
            const double error = mean_of(track[axis], rest.first + part * rows, rows) - mean;
            sums[axis] += error * error * static_cast<double>(rows) * row_s;
        }
    }
}

MeanScatter scatter_of(std::span<const InertialSignals> recordings, const std::vector<Rest>& rests) {
    MeanScatter scatter;
    for (const Rest& rest : rests) {
        const InertialSignals& signals = recordings[rest.recording];
        if (rest.rows < parts_of_a_rest) { continue; }
        if (signals.has_force()) {
            add_scatter(signals.force_m_s2, rest, signals.row_s(), scatter.force_m_s2_sqrt_s);
        }
        if (signals.has_rate()) {
            add_scatter(signals.rate_rad_s, rest, signals.row_s(), scatter.rate_rad_s_sqrt_s);
        }
        scatter.degrees += static_cast<double>(parts_of_a_rest - 1);
    }
    for (std::size_t axis = 0; axis < 3 && scatter.degrees > 0.0; ++axis) {
        for (Vector3* sums : {&scatter.force_m_s2_sqrt_s, &scatter.rate_rad_s_sqrt_s}) {
            (*sums)[axis] = std::sqrt((*sums)[axis] / scatter.degrees);
        }
    }
    return scatter;
}

// Rows that follow each other on the grid from the end of one rest to the begin of the next.
bool is_whole(const Recording& recording, const Rest& before, const Rest& after) {
    return std::ranges::any_of(recording.segments, [&](const Segment& segment) {
        return segment.first <= before.first && after.first + after.rows <= segment.first + segment.count;
    });
}

}  // namespace

Phases find_phases(std::span<const InertialSignals> recordings, const RestOptions& options) {
    Phases phases;
    for (std::size_t i = 0; i < recordings.size(); ++i) {
        for (const Segment& run : runs_of(recordings[i], options)) {
            if (tilts(recordings[i], run, options)) { continue; }
            if (reference_turns(recordings[i], run, options.reference_most_rad_s)) { continue; }
            phases.rests.push_back(rest_of(recordings[i], i, run));
        }
    }
    drop_constant_rates(phases.rests, options.rate_most_rad_s);
    for (std::size_t i = 1; i < phases.rests.size(); ++i) {
        const Rest& before = phases.rests[i - 1];
        const Rest& after = phases.rests[i];
        if (before.recording == after.recording &&
            is_whole(recordings[before.recording].recording, before, after)) {
            phases.moves.push_back({i - 1, i});
        }
    }
    phases.scatter = scatter_of(recordings, phases.rests);
    return phases;
}

}  // namespace gyrolog
