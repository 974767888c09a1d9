// What a recording says of a gyro y = M w + b + K f, w the rate and f the specific force: means over a time
// whose rate is known, and moves that take gravity from one known direction to another.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/calibrate/accelerometer_fit.hpp"
#include "analysis/calibrate/knowledge.hpp"
#include "analysis/calibrate/rests.hpp"

namespace gyrolog {

struct GyroObservationOptions {
    std::optional<double>
        turn_rad;  // how far the sensor was turned, each time, about whatever axis is upright
    // One sigma of a turn by hand against a table's edge.
    double turn_sd_rad = 1.0 * rad_per_deg;
    // One sigma of its axis, for a table that stands level as tables do; more where the rests before and
    // after show more.
    double axis_sd_rad = 0.3 * rad_per_deg;
    // A sum of moves is a turn, or a whole number of turns, if it is that near: a gyro's scale is within 3 %
    // (knowledge.hpp), and a hand within the rest.
    double turn_share = 0.1;
    double upright_rad = 5.0 * rad_per_deg;      // gravity has moved by less: the axis is upright
    double move_least_rad = 20.0 * rad_per_deg;  // less than a turn; what jolts is no move
    // Longer moves say less: the gyro's own drift is in them.
    double move_most_s = 60.0;
    SensorTolerance tolerance;
    double block_s = 1.0;  // of a reference's rates; ten times the largest plausible latency (latency.cpp)
};

enum class ObservationKind { rest, turn, reference, gravity };
inline constexpr std::array observation_kinds{ObservationKind::rest, ObservationKind::turn,
                                              ObservationKind::reference, ObservationKind::gravity};
// "rests", "turns", "reference rates", "moves of gravity".
const char* words_of(ObservationKind kind);

struct MeanRate {
    ObservationKind kind = ObservationKind::rest;
    Vector3 rate_rad_s{};  // true
    Vector3 force_m_s2{};  // 0 without an accelerometer
    Vector3 measured_rad_s{};
    Vector3 sd_rad_s{};
};

// Between two rests.
struct GravityMove {
    std::vector<Vector3> measured_rad_s;  // from the last row of the first to the first row of the second
    std::vector<Vector3> force_m_s2;
    double row_s = 0.0;
    Vector3 up_before{};  // of length one
    Vector3 up_after{};
    double sd_rad = 0.0;  // of each component of a direction, what the gyro's noise adds included
};

struct GyroObservations {
    std::vector<MeanRate> means;
    std::vector<GravityMove> moves;
    bool has_force = false;
    std::size_t turns = 0;
    std::vector<std::string> notes;  // of what was found and could not be used
};

// Where a recording has a reference, that and the rests are what counts: its axes are not the
// accelerometer's. Otherwise turns and moves need a calibrated accelerometer; a turn's axis is told by one
// that is not, too.
GyroObservations gyro_observations(std::span<const InertialSignals> recordings, const Phases& phases,
                                   const std::optional<AccelerometerCalibration>& accelerometer,
                                   double gravity_m_s2, const GyroObservationOptions& options = {});

}  // namespace gyrolog
