// Lines about many recordings, from files to recordings: what `table` and `report` read.
#pragma once

#include <span>
#include <string>

#include "host/base/result.hpp"
#include "host/fleet/fleet_recording.hpp"

namespace gyrolog {

// `expected_path`: the list of names that shall have an answer; empty: none is expected. Errors are those of
// read_fleet_lines() and read_name_list().
Result<FleetRecordings> read_fleet(std::span<const std::string> lines_paths,
                                   const std::string& expected_path);

}  // namespace gyrolog
