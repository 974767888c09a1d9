// An accelerometer presented as a gyro: what compares, diagnoses and denoises gyros takes its recording and
// its model in this form, and its answer is put back. Noise, converter, temperature and faults of the samples
// are alike in both. What motion shows of a gyro, an accelerometer shows of forces: where a recording tells
// what it was exposed to (ref_ax ref_ay ref_az, known_poses.hpp), that is the reference rate. No other
// reference is kept.
#pragma once

#include <optional>

#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// So many rad/s stand for 1 m/s^2. An MPU-9250's gyro has a density of 0.01 dps/sqrt(Hz) where its
// accelerometer has 300 ug/sqrt(Hz) (PS-MPU-9250A-01 rev 1.1, tables 1 and 2): sizes that are plausible of
// the one are plausible of the other.
inline constexpr double accelerometer_rad_s_per_m_s2 = 0.01 / 300e-6 * rad_per_deg / standard_gravity_m_s2;

// Of numbers in that form, for readers: g.
inline SensorUnit unit_of_accelerometer_as_gyro() {
    return {"g", 1.0 / (accelerometer_rad_s_per_m_s2 * standard_gravity_m_s2), SensorKind::accelerometer};
}

// What an accelerometer was exposed to.
enum class Exposure {
    upright,  // gravity on its z axis, as far as anybody knows: at rest a tilt cannot be told from a bias
    known,    // forces that the recording tells
};

// The accelerometer's columns in m/s^2 as those of a gyro, an array's likewise, with the temperature and the
// forces that the recording tells; rows without a value of it are missing. No value where there is no such
// column.
std::optional<Recording> accelerometer_as_gyro(const Recording& recording);

// Of a recording in that form.
Exposure exposure_of(const Recording& as_gyro);

// Its inverse, of what is left of the columns.
Recording accelerometer_of_gyro(Recording as_gyro);

// `model` has an accelerometer. Clock, stamps and thermometer are the whole sensor's. Upright, the mean is
// gravity on the z axis, as resting_accelerometer() has it; exposed to known forces, the matrix is the
// model's.
SensorModel accelerometer_as_gyro(const SensorModel& model, Exposure exposure = Exposure::upright);

// The model with the accelerometer that `as_gyro` is. Where it had one before, the matrix stays that, and so
// does the bias of an upright one.
SensorModel with_accelerometer_of(SensorModel model, const SensorModel& as_gyro,
                                  Exposure exposure = Exposure::upright);

}  // namespace gyrolog
