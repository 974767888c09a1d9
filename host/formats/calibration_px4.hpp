// A calibration as parameters of PX4, in the form that QGroundControl loads (vehicle, component, name, value,
// MAV_PARAM_TYPE, tabs between; written so by PX4-Autopilot, Tools/process_sensor_caldata.py).
//
// What PX4 makes of them, in the sensor's axes, SI units:
//   accelerometer   (raw - thermal - CAL_ACC0_?OFF) * CAL_ACC0_?SCALE
//                   (PX4-Autopilot, src/lib/sensor_calibration/Accelerometer.hpp, Correct)
//   gyro            raw - thermal - CAL_GYRO0_?OFF
//                   (src/lib/sensor_calibration/Gyroscope.hpp, Correct)
//   thermal         X0 + X1 t + X2 t^2 + X3 t^3, t = T - TREF, T kept within TMIN ... TMAX
//                   (src/modules/temperature_compensation/TemperatureCompensation.cpp,
//                   calc_thermal_offsets_3D)
// X0 is 0: the bias at TREF is in the offset, which holds without the compensation, too. There is no
// misalignment, no scale of a gyro and no g-sensitivity: the file's head says how much is left out. The scale
// of an axis is the one whose result is nearest over all directions (axis_scales() of sensor_matrix.hpp).
#pragma once

#include <string>

#include "analysis/calibrate/calibration.hpp"

namespace gyrolog {

std::string px4_parameters(const Calibration& calibration);

}  // namespace gyrolog
