// What a command's help says of a model that it reads (model_source.hpp).
#pragma once

namespace gyrolog {

inline constexpr const char* model_file_help =
    "gyrolog's own (.json), or a simulator's file: SDF, PX4's and RotorS' imu plugins, MJCF, AirSim's "
    "settings, "
    "Kalibr's imu.yaml; FILE#SENSOR names one of several";

}  // namespace gyrolog
