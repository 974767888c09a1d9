#include "analysis/calibrate/rests.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/calibrate/sensor_matrix.hpp"
#include "analysis/recording/grid_step.hpp"
#include "analysis/recording/still_runs.hpp"

namespace gyrolog {
namespace {

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

// Of recordings that have a gyro.
void drop_constant_rates(std::vector<Rest>& rests, std::span<const InertialSignals> recordings,
                         double most_rad_s) {
    const Rest* slowest = nullptr;
    for (const Rest& rest : rests) {
        if (!recordings[rest.recording].has_rate()) { continue; }
        if (slowest == nullptr || norm(rest.rate_rad_s) < norm(slowest->rate_rad_s)) { slowest = &rest; }
    }
    if (slowest == nullptr) { return; }
    const Vector3 slowest_rad_s = slowest->rate_rad_s;
    std::erase_if(rests, [&](const Rest& rest) {
        return recordings[rest.recording].has_rate() &&
               norm(difference(rest.rate_rad_s, slowest_rad_s)) > most_rad_s;
    });
}

// Of one sensor, over the rests of all recordings that have it.
class SensorScatter {
public:
    explicit SensorScatter(const RestOptions& options) : options_(options) {}

    // The squares of the parts' means about the rest's, times the seconds of a part; and of the rows.
    void add(const VectorTrack& track, const Rest& rest, double row_s) {
        const std::size_t rows = rest.rows / options_.parts;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double mean = mean_of(track[axis], rest.first, rows * options_.parts);
            for (std::size_t part = 0; part < options_.parts; ++part) {
                const double error = mean_of(track[axis], rest.first + part * rows, rows) - mean;
                parts_[axis] += error * error * static_cast<double>(rows) * row_s;
            }
            for (std::size_t row = rest.first; row < rest.first + rest.rows; ++row) {
                rows_[axis] += (track[axis][row] - mean) * (track[axis][row] - mean);
            }
        }
        degrees_ += static_cast<double>(options_.parts - 1);
        row_count_ += static_cast<double>(rest.rows);
    }

    void add_steps(const Recording& recording, const std::string& prefix) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            step_[axis] = std::max(step_[axis], grid_step(*recording.find(prefix + axis_names[axis])));
        }
    }

    double degrees() const { return degrees_; }
    Vector3 density() const {
        Vector3 density{};
        for (std::size_t axis = 0; axis < 3 && degrees_ > 0.0; ++axis) {
            density[axis] = std::sqrt(parts_[axis] / degrees_);
        }
        return density;
    }
    Vector3 floor(double sd_least) const {
        Vector3 floor{sd_least, sd_least, sd_least};
        for (std::size_t axis = 0; axis < 3 && row_count_ > 0.0; ++axis) {
            if (std::sqrt(rows_[axis] / row_count_) >= options_.sd_in_steps_least * step_[axis]) { continue; }
            floor[axis] = std::max(sd_least, step_[axis] / std::sqrt(12.0));
        }
        return floor;
    }

private:
    const RestOptions& options_;
    Vector3 parts_{};
    Vector3 rows_{};
    Vector3 step_{};
    double degrees_ = 0.0;
    double row_count_ = 0.0;
};

MeanScatter scatter_of(std::span<const InertialSignals> recordings, const std::vector<Rest>& rests,
                       const RestOptions& options) {
    SensorScatter force(options);
    SensorScatter rate(options);
    for (const InertialSignals& signals : recordings) {
        if (signals.has_force()) { force.add_steps(signals.recording, "a"); }
        if (signals.has_rate()) { rate.add_steps(signals.recording, "g"); }
    }
    for (const Rest& rest : rests) {
        const InertialSignals& signals = recordings[rest.recording];
        if (rest.rows < options.parts) { continue; }
        if (signals.has_force()) { force.add(signals.force_m_s2, rest, signals.row_s()); }
        if (signals.has_rate()) { rate.add(signals.rate_rad_s, rest, signals.row_s()); }
    }
    return {force.density(),
            rate.density(),
            force.floor(options.force_sd_least_m_s2),
            rate.floor(options.rate_sd_least_rad_s),
            force.degrees(),
            rate.degrees()};
}

Vector3 sd_of_mean(const Vector3& density, const Vector3& floor, double duration_s) {
    Vector3 sd{};
    for (std::size_t axis = 0; axis < sd.size(); ++axis) {
        sd[axis] = std::hypot(density[axis] / std::sqrt(duration_s), floor[axis]);
    }
    return sd;
}

// Rows that follow each other on the grid from the end of one rest to the begin of the next.
bool is_whole(const Recording& recording, const Rest& before, const Rest& after) {
    return std::ranges::any_of(recording.segments, [&](const Segment& segment) {
        return segment.first <= before.first && after.first + after.rows <= segment.first + segment.count;
    });
}

}  // namespace

Vector3 MeanScatter::force_sd_m_s2(double duration_s) const {
    return sd_of_mean(force_m_s2_sqrt_s, force_floor_m_s2, duration_s);
}

Vector3 MeanScatter::rate_sd_rad_s(double duration_s) const {
    return sd_of_mean(rate_rad_s_sqrt_s, rate_floor_rad_s, duration_s);
}

Phases find_phases(std::span<const InertialSignals> recordings, const RestOptions& options) {
    Phases phases;
    for (std::size_t i = 0; i < recordings.size(); ++i) {
        for (const Segment& run : runs_of(recordings[i], options)) {
            if (tilts(recordings[i], run, options)) { continue; }
            if (reference_turns(recordings[i], run, options.reference_most_rad_s)) { continue; }
            phases.rests.push_back(rest_of(recordings[i], i, run));
        }
    }
    drop_constant_rates(phases.rests, recordings, options.rate_most_rad_s);
    for (std::size_t i = 1; i < phases.rests.size(); ++i) {
        const Rest& before = phases.rests[i - 1];
        const Rest& after = phases.rests[i];
        if (before.recording == after.recording &&
            is_whole(recordings[before.recording].recording, before, after)) {
            phases.moves.push_back({i - 1, i});
        }
    }
    phases.scatter = scatter_of(recordings, phases.rests, options);
    return phases;
}

}  // namespace gyrolog
