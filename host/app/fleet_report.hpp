// From lines about many recordings to a page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"

namespace gyrolog {

// By the ending, with that of a compression behind it or not: ".jsonl".
bool is_named_like_lines(const std::string& path);

struct FleetReportRequest {
    std::vector<std::string> lines_paths;
    std::string expected_path;  // empty: no list
    std::string page_path;
};

ExitCode fleet_report_to_file(Console& console, const FleetReportRequest& request);

}  // namespace gyrolog
