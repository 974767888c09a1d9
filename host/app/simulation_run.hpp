// A simulated recording on its way to a file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/simulate/recording_simulator.hpp"
#include "host/app/console.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// What came of it.
struct SimulationOutcome {
    std::uint64_t instants = 0;  // sampling instants simulated, lost ones too
    std::uint64_t samples = 0;   // rows written
    std::uint64_t dropouts = 0;  // holes between them
    double rate_hz = 0.0;
    bool interrupted = false;  // the user stopped it: the file is whole up to there
};

// What the text will take, without compression: as many bytes a row as the first rows have, for all sampling
// instants but the share that the first rows lost.
double text_bytes_of(const SensorModel& model, const SimulationRequest& request);

// Writes text; memory does not grow with the length. Shows progress where the console has it. The file takes
// its place when it is complete, or the user has stopped it.
Result<SimulationOutcome> simulate_to_text(Console& console, const SensorModel& model,
                                           const SimulationRequest& request, const std::string& path);

}  // namespace gyrolog
