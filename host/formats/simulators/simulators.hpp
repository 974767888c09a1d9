// The simulators by name, for simulator_format.cpp. Each is told of in its file.
#pragma once

#include "host/formats/simulators/simulator_format.hpp"

namespace gyrolog {

extern const SimulatorFormat airsim_format;
extern const SimulatorFormat carla_format;
extern const SimulatorFormat genesis_format;
extern const SimulatorFormat gnss_ins_sim_format;
extern const SimulatorFormat isaaclab_format;
extern const SimulatorFormat jmavsim_format;
extern const SimulatorFormat mjcf_format;
extern const SimulatorFormat navego_format;
extern const SimulatorFormat pegasus_format;
extern const SimulatorFormat px4_classic_format;
extern const SimulatorFormat rotors_format;
extern const SimulatorFormat sdf_format;
extern const SimulatorFormat webots_format;

}  // namespace gyrolog
