// A calibration of one sensor from its recordings: rests, turns and ramps are found, and what they determine
// is fitted: the temperature's part first (temperature_fit.hpp), what is left of the rests for the
// accelerometer (accelerometer_fit.hpp), and with it for the gyro (gyro_fit.hpp). The uncertainty of an
// earlier step is not in that of a later one; it is small where each is determined at all.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/calibrate/accelerometer_fit.hpp"
#include "analysis/calibrate/gyro_fit.hpp"
#include "analysis/calibrate/gyro_observations.hpp"
#include "analysis/calibrate/rests.hpp"
#include "analysis/calibrate/temperature_fit.hpp"

namespace gyrolog {

struct CalibrationOptions {
    RestOptions rests;
    TemperatureFitOptions temperature;
    AccelerometerFitOptions accelerometer;
    GyroObservationOptions observations;
    GyroFitOptions gyro;
    // A wrong sampling rate or axis is warned of: where a gyro's scale is off by ten times a data sheet's
    // tolerance, and where gravity ends farther from where the gyro carries it (root mean square of the
    // moves) than a scale within 3 % lets it, 3 deg in a right angle.
    double scale_off_least = 10.0 * SensorTolerance{}.scale;
    double miss_least_rad = 5.0 * rad_per_deg;
};

// What is not known, and what to record for it.
struct Undetermined {
    std::string what;
    std::string add;
};

struct Calibration {
    std::vector<std::string> recordings;  // their names
    double gravity_m_s2 = 0.0;
    Phases phases;  // with the temperature's part taken out
    bool has_gyro = false;
    bool has_accelerometer = false;
    bool has_reference = false;
    bool has_temperature = false;
    std::optional<double> temperature_C;  // mean of the rests; the biases are those at the polynomials'
                                          // reference where there is one, else at this
    TemperatureResult gyro_temperature;
    TemperatureResult accelerometer_temperature;
    AccelerometerResult accelerometer;
    GyroResult gyro;
    std::size_t turns = 0;  // by a known angle
    std::size_t moves = 0;  // of gravity
    std::vector<Undetermined> undetermined;
    std::vector<std::string> warnings;

    // More than the gyro's bias.
    bool determines_anything() const;
};

// At least one recording.
Calibration calibrate(std::vector<Recording> recordings, const CalibrationOptions& options = {});

}  // namespace gyrolog
