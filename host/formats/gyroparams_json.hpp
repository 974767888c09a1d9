// The parameters of MathWorks' gyroparams (Navigation Toolbox; the Simulink IMU block has the same) as JSON,
// schema gyrolog-gyroparams/1, under their names and in their units:
//
//   {
//     "schema": "gyrolog-gyroparams/1",
//     "SampleRate": 100,                           Hz, of imuSensor; needed
//     "MeasurementRange": 8.7266,                  rad/s; without it no limit
//     "Resolution": 2.66e-4,                       (rad/s)/LSB
//     "ConstantBias": [0.005, 0, 0],               rad/s
//     "AxesMisalignment": [0.5, 0, 0],             %: scalar, [x y z] or 3x3
//     "NoiseType": "single-sided",                 or "double-sided"; needed beside noise
//     "NoiseDensity": [1.7e-4, 1.7e-4, 1.7e-4],    (rad/s)/sqrt(Hz)
//     "BiasInstability": [3.5e-5, 3.5e-5, 3.5e-5], rad/s
//     "RandomWalk": [1.7e-6, 1.7e-6, 1.7e-6],      (rad/s) sqrt(Hz): rate random walk
//     "TemperatureBias": [0, 0, 0],                (rad/s)/degC, about 25 degC
//     "TemperatureScaleFactor": [0, 0, 0],         %/degC, about 25 degC
//     "AccelerationBias": [0, 0, 0]                (rad/s)/(m/s^2)
//   }
//
// Each may be one number for all axes or three; a missing one is zero. AxesMisalignment [a b c] stands for
// [100 b c; a 100 c; a b 100], one number a for [a a a]; a full matrix is taken as it is. AccelerationBias of
// an axis multiplies the specific force along that axis, gravity's own included. BiasInstabilityCoefficients
// is accepted and has no effect: the 1/f noise is exact, not a filter's. Another key is an error.
//
// NoiseType does not mean what its words say, and has no default here.
// imuSensor's generated code makes white noise of the deviation NoiseDensity sqrt(w) and a random walk of
// steps RandomWalk / sqrt(w), with w = SampleRate for "single-sided" and half of it for "double-sided". With
// "single-sided" they are thus N and K of the Allan deviation, the roots of two-sided densities (MathWorks'
// own example of noise analysis sets it for N and K so read); with "double-sided" N is NoiseDensity / sqrt(2)
// and K is sqrt(2) RandomWalk. BiasInstability is B with either.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/simulate/sensor_model.hpp"
#include "host/formats/json_fwd.hpp"

namespace gyrolog {

inline constexpr const char* gyroparams_schema = "gyrolog-gyroparams/1";

// `problem`: the first thing that is wrong, with its key; the answer is then of no use.
SensorModel read_gyroparams(const Json& document, std::optional<std::string>& problem,
                            std::vector<std::string>& notes);

}  // namespace gyrolog
