// A recording as a calibration sees it: three rates, three forces, a temperature, and what is known of the
// motion, each row known.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

using VectorTrack = std::array<std::vector<double>, 3>;  // an axis each, one value a row

// Tracks that the recording lacks are empty. A sensor counts with all three axes only.
struct InertialSignals {
    Recording recording;                // its rows are those whose rates and forces are known
    VectorTrack rate_rad_s;             // gx gy gz
    VectorTrack force_m_s2;             // ax ay az
    VectorTrack reference_rad_s;        // ref_x ref_y ref_z, or the rate of ref_qw ... (recorded_world.hpp)
    std::vector<double> temperature_C;  // smooth, as recorded_world.hpp has it

    bool has_rate() const { return !rate_rad_s[0].empty(); }
    bool has_force() const { return !force_m_s2[0].empty(); }
    bool has_reference() const { return !reference_rad_s[0].empty(); }
    bool has_temperature() const { return !temperature_C.empty(); }
    double row_s() const { return 1.0 / recording.rate_hz; }
};

// With a reference, rows whose motion is not known are left out (known_motion.hpp), and the recording's
// warnings say so.
InertialSignals inertial_signals(Recording recording);

// The mean of rows first ... first + rows - 1.
Vector3 mean_of(const VectorTrack& track, std::size_t first, std::size_t rows);
double mean_of(const std::vector<double>& track, std::size_t first, std::size_t rows);

}  // namespace gyrolog
