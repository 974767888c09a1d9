// Many recordings on one page: how far their units lie apart, which of them stand out, what the diagnoses
// found, and which recordings gave no answer. A page like that of one recording (report_page.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "host/fleet/fleet_recording.hpp"
#include "host/fleet/unit_population.hpp"

namespace gyrolog {

struct PopulationParameter {
    const char* name;
    const char* title;
    const char* unit;  // the population's (population_json.hpp), as people write it
};
inline constexpr std::array population_parameters{
    PopulationParameter{"bias", "bias", "°/s"},
    PopulationParameter{"N", "N, angle random walk", "°/s/√Hz"},
    PopulationParameter{"B", "B, bias instability", "°/s"},
    PopulationParameter{"K", "K, rate random walk", "°/s·√Hz"},
    PopulationParameter{"Q", "Q, quantization noise", "°/s·s"},
    PopulationParameter{"rate_hz", "sampling rate", "Hz"},
};

struct FleetPage {
    std::string name;
    const FleetRecordings& read;
    const UnitPopulation& population;        // of these recordings
    std::vector<std::uint8_t> spread_png{};  // empty where there is none
};

std::string fleet_html(const FleetPage& page);

}  // namespace gyrolog
