#include "analysis/simulate/recorded_world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/orientation_rate.hpp"
#include "analysis/simulate/recorded_orientation.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

namespace {

constexpr double window_half_s = 5.0;
constexpr double window_rows = 30.0;
constexpr double moment_s = 0.1;

const Column* find_in(const Recording& recording, const std::string& name, std::string_view unit) {
    const Column* column = recording.find(name);
    return column != nullptr && column->unit == unit ? column : nullptr;
}

std::size_t unknown_in(const std::vector<double>& track) {
    return static_cast<std::size_t>(
        std::ranges::count_if(track, [](double value) { return !std::isfinite(value); }));
}

// Sums of a straight line's normal equations about one abscissa.
struct LineSums {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;

    void add(double at, double value) {
        n += 1.0;
        x += at;
        y += value;
        xx += at * at;
        xy += at * value;
    }
    double at_zero() const {
        const double spread = n * xx - x * x;
        // All at one place: their mean.
        if (spread <= 1e-9 * n * xx || n < 3.0) { return y / n; }
        return (xx * y - x * xy) / spread;
    }
};

}  // namespace

RecordedWorld::RecordedWorld(std::shared_ptr<const Recording> recording) : recording_(std::move(recording)) {
    for (const Segment& segment : recording_->segments) {
        segment_slot_.push_back(segment.first_index - recording_->segments.front().first_index);
    }
    if (recording_->rows() == 0) { return; }
    read_reference();
    read_specific_force();
    read_temperature();
    beat_ = gyrolog::recorded_beat(*recording_);
}

void RecordedWorld::read_reference() {
    std::string without;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Column* column = find_in(*recording_, std::string("ref_") + axis_names[axis], "rad/s");
        if (column == nullptr) {
            without += (without.empty() ? "" : ", ") + std::string(axis_names[axis]);
            continue;
        }
        rate_rad_s_[axis] = column->values();
        has_reference_ = true;
    }
    if (has_reference_ && !without.empty()) {
        warnings_.push_back("no reference rate of axis " + without + ": taken as not turning");
    }
    if (!has_reference_) {
        if (!has_orientation(*recording_)) { return; }
        read_orientation_rate();
    }
    drop_empty(rate_rad_s_, "the reference rate");
    stand_still_where_long_unknown();
    join_unknown(rate_rad_s_, "the reference rate");
    has_reference_ = std::ranges::any_of(rate_rad_s_, [](const Track& track) { return !track.empty(); });
}

bool RecordedWorld::reference_changes() const {
    const auto changes_in = [](const Track& track, const Segment& segment) {
        const auto begin = track.begin() + static_cast<std::ptrdiff_t>(segment.first);
        const auto end = begin + static_cast<std::ptrdiff_t>(segment.count);
        return std::adjacent_find(begin, end, std::not_equal_to()) != end;
    };
    return std::ranges::any_of(rate_rad_s_, [&](const Track& track) {
        return !track.empty() && std::ranges::any_of(recording_->segments, [&](const Segment& segment) {
            return changes_in(track, segment);
        });
    });
}

void RecordedWorld::read_orientation_rate() {
    for (Track& track : rate_rad_s_) { track.resize(recording_->rows()); }
    for (const Segment& segment : recording_->segments) {
        const auto rates = orientation_rate(recorded_orientation(*recording_, segment), recording_->rate_hz);
        for (std::size_t k = 0; k < segment.count; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                rate_rad_s_[axis][segment.first + k] = rates[k][axis];
            }
        }
    }
}

void RecordedWorld::read_specific_force() {
    std::array<const Column*, 3> columns{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        columns[axis] = find_in(*recording_, std::string("a") + axis_names[axis], "m/s^2");
        if (columns[axis] == nullptr) { return; }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) { specific_force_m_s2_[axis] = columns[axis]->values(); }
    drop_empty(specific_force_m_s2_, "the specific force");
    join_unknown(specific_force_m_s2_, "the specific force");
    for (const Track& track : specific_force_m_s2_) {
        if (track.empty()) { return; }
    }
    has_specific_force_ = true;
}

void RecordedWorld::drop_empty(std::array<Track, 3>& tracks, const std::string& what) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Track& track = tracks[axis];
        if (track.empty() || unknown_in(track) < track.size()) { continue; }
        warnings_.push_back(what + " of axis " + axis_names[axis] +
                            " is known nowhere: taken as not recorded");
        track.clear();
    }
}

void RecordedWorld::stand_still_where_long_unknown() {
    const double moment_rows = std::max(2.0, moment_s * recording_->rate_hz);
    std::vector<bool> unknown(recording_->rows(), false);
    for (Track& track : rate_rad_s_) {
        for (std::size_t row = 0; row < track.size();) {
            std::size_t known = row;
            while (known < track.size() && !std::isfinite(track[known])) { ++known; }
            const std::size_t rows = known - row;
            if (static_cast<double>(rows) > moment_rows) {
                const auto first = static_cast<std::ptrdiff_t>(row);
                std::fill_n(track.begin() + first, rows, 0.0);
                std::fill_n(unknown.begin() + first, rows, true);
            }
            row = known + 1;
        }
    }
    const auto still = std::ranges::count(unknown, true);
    if (still == 0) { return; }
    is_long_unknown_ = std::move(unknown);
    warnings_.push_back("the reference rate is not known in " + std::to_string(still) + " of " +
                        std::to_string(recording_->rows()) +
                        " samples for longer than a moment: taken as not turning there");
}

void RecordedWorld::join_unknown(std::array<Track, 3>& tracks, const std::string& what) {
    std::size_t most = 0;
    for (Track& track : tracks) {
        const std::size_t unknown = unknown_in(track);
        if (unknown == 0) { continue; }
        most = std::max(most, unknown);
        join_unknown(track);
    }
    if (most == 0) { return; }
    warnings_.push_back(what + " is not known in " + std::to_string(most) + " of " +
                        std::to_string(recording_->rows()) +
                        " samples: joined by straight lines there, held at the ends");
}

void RecordedWorld::join_unknown(Track& track) const {
    std::optional<std::size_t> last;
    std::int64_t last_slot = 0;
    std::vector<std::pair<std::size_t, std::int64_t>> waiting;  // rows since, with their slots
    for (std::size_t s = 0; s < recording_->segments.size(); ++s) {
        const Segment& segment = recording_->segments[s];
        for (std::size_t i = 0; i < segment.count; ++i) {
            const std::size_t row = segment.first + i;
            const std::int64_t slot = segment_slot_[s] + static_cast<std::int64_t>(i);
            if (!std::isfinite(track[row])) {
                waiting.emplace_back(row, slot);
                continue;
            }
            for (const auto& [at, at_slot] : waiting) {
                const double part =
                    last ? static_cast<double>(at_slot - last_slot) / static_cast<double>(slot - last_slot)
                         : 1.0;
                const double from = track[last.value_or(row)];
                track[at] = from + part * (track[row] - from);
            }
            waiting.clear();
            last = row;
            last_slot = slot;
        }
    }
    for (const auto& rest : waiting) { track[rest.first] = track[*last]; }
}

void RecordedWorld::read_temperature() {
    const Column* column = find_in(*recording_, "temp", "degC");
    if (column == nullptr) { return; }
    std::vector<Knot> known;
    known.reserve(column->size());
    for (std::size_t s = 0; s < recording_->segments.size(); ++s) {
        const Segment& segment = recording_->segments[s];
        for (std::size_t i = 0; i < segment.count; ++i) {
            const double value_C = column->value(segment.first + i);
            const double slot = static_cast<double>(segment_slot_[s]) + static_cast<double>(i);
            if (std::isfinite(value_C)) { known.push_back({slot / recording_->rate_hz, value_C}); }
        }
    }
    if (known.empty()) {
        warnings_.emplace_back("the temperature is known nowhere: taken as not recorded");
        return;
    }
    if (known.size() < column->size()) {
        warnings_.push_back("the temperature is not known in " +
                            std::to_string(column->size() - known.size()) + " of " +
                            std::to_string(column->size()) + " samples: joined by straight lines there");
    }
    smooth_temperature(known);
}

void RecordedWorld::smooth_temperature(std::span<const Knot> known) {
    const double half_s = std::max(window_half_s, 0.5 * window_rows / recording_->rate_hz);
    const double knot_s = half_s / 5.0;
    std::size_t begin = 0;
    for (std::int64_t knot = 0;; ++knot) {
        double centre_s = static_cast<double>(knot) * knot_s;
        while (begin < known.size() && known[begin].at_s < centre_s - half_s) { ++begin; }
        if (begin == known.size() || centre_s >= known.back().at_s + knot_s) { break; }
        if (known[begin].at_s > centre_s + half_s) {  // a hole: on to the first window that reaches its end
            knot = static_cast<std::int64_t>(std::ceil((known[begin].at_s - half_s) / knot_s));
            centre_s = static_cast<double>(knot) * knot_s;
        }
        LineSums sums;
        const double reference_C = known[begin].value_C;
        for (std::size_t i = begin; i < known.size() && known[i].at_s <= centre_s + half_s; ++i) {
            sums.add(known[i].at_s - centre_s, known[i].value_C - reference_C);
        }
        temperature_C_.push_back({centre_s, reference_C + sums.at_zero()});
    }
}

// The last segment that begins at or before the slot; the first one for what comes before.
std::size_t RecordedWorld::segment_at(double slot, std::size_t guess) const {
    const auto begins_by = [&](std::size_t s) { return static_cast<double>(segment_slot_[s]) <= slot; };
    if (begins_by(guess) && (guess + 1 == segment_slot_.size() || !begins_by(guess + 1))) { return guess; }
    const auto after =
        std::upper_bound(segment_slot_.begin(), segment_slot_.end(), slot,
                         [](double x, std::int64_t begin) { return x < static_cast<double>(begin); });
    return after == segment_slot_.begin() ? 0 : static_cast<std::size_t>(after - segment_slot_.begin()) - 1;
}

double RecordedWorld::value_at(const Track& track, double slot, std::size_t segment_number) const {
    const Segment& segment = recording_->segments[segment_number];
    const double place = slot - static_cast<double>(segment_slot_[segment_number]);
    if (place <= 0.0) { return track[segment.first]; }
    const std::size_t last = segment.first + segment.count - 1;
    const double beyond = place - static_cast<double>(segment.count - 1);
    if (beyond >= 0.0) {
        if (segment_number + 1 == recording_->segments.size()) { return track[last]; }
        const double hole =
            static_cast<double>(segment_slot_[segment_number + 1] - segment_slot_[segment_number]) -
            static_cast<double>(segment.count - 1);
        return track[last] + beyond / hole * (track[last + 1] - track[last]);
    }
    const auto whole = static_cast<std::size_t>(place);
    const double t = place - static_cast<double>(whole);
    const double* at = &track[segment.first + whole];
    if (whole == 0 || whole + 2 >= segment.count) { return at[0] + t * (at[1] - at[0]); }
    // Lagrange's cubic through the samples at -1, 0, 1 and 2.
    const double through_ends = (at[2] - at[-1]) / 6.0 + (at[0] - at[1]) / 2.0;
    const double bend = (at[-1] + at[1]) / 2.0 - at[0];
    const double slope = at[1] - at[0] - through_ends - bend;
    return at[0] + t * (slope + t * (bend + t * through_ends));
}

void RecordedWorld::motion(std::span<const double> world_s,
                           const std::array<std::span<double>, 3>& rate_rad_s,
                           const std::array<std::span<double>, 3>& specific_force_m_s2) const {
    std::size_t segment = 0;
    for (std::size_t i = 0; i < world_s.size(); ++i) {
        const double slot = world_s[i] * recording_->rate_hz;
        segment = segment_at(slot, segment);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            rate_rad_s[axis][i] =
                rate_rad_s_[axis].empty() ? 0.0 : value_at(rate_rad_s_[axis], slot, segment);
            if (has_specific_force_) {
                specific_force_m_s2[axis][i] = value_at(specific_force_m_s2_[axis], slot, segment);
            } else {
                specific_force_m_s2[axis][i] = axis == 2 ? standard_gravity_m_s2 : 0.0;
            }
        }
    }
}

void RecordedWorld::temperature(std::span<const double> world_s, std::span<double> temperature_C) const {
    const std::span<const Knot> knots = temperature_C_;
    const auto later = [](double at_s, const Knot& knot) { return at_s < knot.at_s; };
    auto after = knots.begin();
    for (std::size_t i = 0; i < world_s.size(); ++i) {
        // Mostly still between the knots of the sample before.
        const bool same = after != knots.begin() && after != knots.end() && world_s[i] < after->at_s &&
                          world_s[i] >= (after - 1)->at_s;
        if (!same) { after = std::upper_bound(knots.begin(), knots.end(), world_s[i], later); }
        if (after == knots.begin() || after == knots.end()) {
            temperature_C[i] = after == knots.begin() ? knots.front().value_C : knots.back().value_C;
            continue;
        }
        const Knot& before = *(after - 1);
        const double part = (world_s[i] - before.at_s) / (after->at_s - before.at_s);
        temperature_C[i] = before.value_C + part * (after->value_C - before.value_C);
    }
}

}  // namespace gyrolog
