// A calibration with known numbers, and the sensor that it describes.
#pragma once

#include "analysis/calibrate/calibration.hpp"
#include "tests/analysis/calibrate/moved_sensor.hpp"

namespace gyrolog {

inline FaultySensor warm_sensor() {
    FaultySensor sensor;
    sensor.gyro_c = {4e-4, 5e-6, -1e-7};
    sensor.acc_c = {3e-3, -4e-5, 1e-6};
    return sensor;
}

inline CalibrationOptions whole_turns() {
    CalibrationOptions options;
    options.observations.turn_rad = 2.0 * std::numbers::pi;
    return options;
}

inline Recording warm_session(const FaultySensor& sensor, std::uint64_t seed = 51) {
    MovedSensor moved(sensor, seed, 50.0);
    moved.set_temperature_C(10.0);
    moved.warm(200.0, 44.0);
    whole_session(moved);
    return moved.recording("session.csv", true);
}

inline Calibration made_calibration(const FaultySensor& sensor = warm_sensor()) {
    return calibrate({warm_session(sensor)}, whole_turns());
}

}  // namespace gyrolog
