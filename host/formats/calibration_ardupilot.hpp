// A calibration as parameters of ArduPilot, NAME,VALUE line by line.
//
// What ArduPilot makes of them, in the sensor's axes, SI units (ardupilot, libraries/AP_InertialSensor/,
// AP_InertialSensor_Backend.cpp, _rotate_and_correct_accel and _rotate_and_correct_gyro):
//   accelerometer   (raw - p(T) + p(INS_ACC1_CALTEMP) - INS_ACCOFFS_?) * INS_ACCSCAL_?
//   gyro            raw - p(T) + p(INS_GYR1_CALTEMP) - INS_GYROFFS_?
//   p(T)            1e-6 (c1 s + c2 s^2 + c3 s^3), s = T - 35 degC, T kept within TMIN ... TMAX; c1 is
//                   INS_TCAL1_ACC1_? or INS_TCAL1_GYR1_? (AP_InertialSensor_tempcal.cpp, correct_sensor)
// The polynomial about our reference is written about 35 degC; its constant falls out of the difference. One
// range of temperature serves both sensors: the one that both have seen. There is no misalignment, no scale
// of a gyro and no g-sensitivity: the file's head says how much is left out.
#pragma once

#include <string>

#include "analysis/calibrate/calibration.hpp"

namespace gyrolog {

std::string ardupilot_parameters(const Calibration& calibration);

}  // namespace gyrolog
