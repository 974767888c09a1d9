// What happened to a sensor while it was recorded, as a world for a simulated one: the reference's rates, the
// accelerometer's specific force, the temperature.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/update_beat.hpp"
#include "analysis/simulate/world.hpp"

namespace gyrolog {

// World time 0 is the recording's first sampling instant; time runs on the recording's grid, at its rate.
//
// Rates: ref_x ref_y ref_z, or else the rate of the orientation ref_qw ... ref_qz, which leaves a bandwidth
// of 12.5 Hz and, of a real one by optical markers at rest, 0.4 to 1.5 deg/s of noise (orientation_rate.hpp,
// METHODS.md). An axis without reference is taken not to turn. Between samples: the cubic through the four
// nearest where they follow each other without a hole, else a straight line. Where the reference is not known
// (NaN) for no more than 0.1 s (at least two rows), and in a hole of the recording, a straight line joins
// what is known on either side, and the nearest value is held before the first and after the last; where it
// is unknown for longer, the sensor is taken not to turn: one noisy value held would be a rotation that never
// was. What judges a sensor by such a world leaves those samples out first (known_motion.hpp).
//
// Specific force: ax ay az, likewise, but joined and held however long; without them gravity on z. The
// accelerometer's noise is in it.
//
// Temperature: the recorded one has the thermometer's noise, which the die has not. What acts is a straight
// line fitted to the samples within 5 s on either side (at least 30 rows), a fifth of that apart, joined by
// straight lines. At 100 Hz that leaves 1/30 of the noise; a settling with a time constant of 60 s, the
// fastest of interest, is followed to 0.1 % of its excursion.
class RecordedWorld final : public World {
public:
    explicit RecordedWorld(std::shared_ptr<const Recording> recording);

    const Recording& recording() const { return *recording_; }
    // What was odd about the columns and what was done about it, for the user.
    const std::vector<std::string>& warnings() const { return warnings_; }
    bool has_reference() const { return has_reference_; }
    // One value a row, joined and held as above; empty for an axis without reference.
    const std::vector<double>& rate_rad_s(std::size_t axis) const { return rate_rad_s_[axis]; }
    // One value a row: the rate of an axis is unknown there for longer than it is joined. Empty: nowhere.
    const std::vector<bool>& is_long_unknown() const { return is_long_unknown_; }
    // Between rows that follow each other without a hole.
    bool reference_changes() const;
    bool has_specific_force() const { return has_specific_force_; }

    // With a reference, or an accelerometer.
    bool moves() const override { return has_reference_ || has_specific_force_; }
    bool is_measured() const override { return has_reference_; }
    void motion(std::span<const double> world_s, const std::array<std::span<double>, 3>& rate_rad_s,
                const std::array<std::span<double>, 3>& specific_force_m_s2) const override;
    bool has_temperature() const override { return !temperature_C_.empty(); }
    void temperature(std::span<const double> world_s, std::span<double> temperature_C) const override;
    const UpdateBeat* recorded_beat() const override { return beat_ ? &*beat_ : nullptr; }

private:
    using Track = std::vector<double>;  // one value a row, no NaN; empty: not there
    struct Knot {
        double at_s;
        double value_C;
    };

    void read_reference();
    void read_specific_force();
    void read_temperature();
    void smooth_temperature(std::span<const Knot> known);
    void read_orientation_rate();
    void drop_empty(std::array<Track, 3>& tracks, const std::string& what);
    void stand_still_where_long_unknown();
    void join_unknown(std::array<Track, 3>& tracks, const std::string& what);
    void join_unknown(Track& track) const;
    std::size_t segment_at(double slot, std::size_t guess) const;
    double value_at(const Track& track, double slot, std::size_t segment) const;

    std::shared_ptr<const Recording> recording_;
    std::vector<std::int64_t> segment_slot_;  // of each segment's first row, counted from the first row's
    std::array<Track, 3> rate_rad_s_;
    std::vector<bool> is_long_unknown_;
    std::array<Track, 3> specific_force_m_s2_;
    std::vector<Knot> temperature_C_;  // smooth
    bool has_reference_ = false;
    bool has_specific_force_ = false;
    std::optional<UpdateBeat> beat_;
    std::vector<std::string> warnings_;
};

}  // namespace gyrolog
