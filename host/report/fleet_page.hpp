// Many recordings on one page: how far their units lie apart, which of them stand out, what the diagnoses
// found, and which recordings gave no answer. A page like that of one recording (report_page.hpp).
#pragma once

#include <string>

#include "host/fleet/fleet_recording.hpp"
#include "host/fleet/unit_population.hpp"

namespace gyrolog {

struct FleetPage {
    std::string name;
    const FleetRecordings& read;
    const UnitPopulation& population;  // of these recordings
};

std::string fleet_html(const FleetPage& page);

}  // namespace gyrolog
