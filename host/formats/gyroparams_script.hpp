// A MATLAB script that makes a gyroparams object (Navigation Toolbox, Sensor Fusion and Tracking Toolbox).
//
// MathWorks' names: NoiseDensity is N, BiasInstability is B (their flat Allan deviation is 0.664 B, as in
// IEEE Std 952-1997), RandomWalk is the rate random walk K, not the angle random walk of data sheets.
// NoiseType "single-sided" is the one that simulates such an N and K (gyroparams_json.hpp says why).
#pragma once

#include <string>

#include "host/formats/export_source.hpp"

namespace gyrolog {

// A term that is not identified is 0, with a comment.
std::string gyroparams_script(const ExportSource& source);

}  // namespace gyrolog
