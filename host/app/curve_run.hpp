// From a printed Allan curve to its report, plot and model.
#pragma once

#include <optional>
#include <string>

#include "analysis/plot/paper_size.hpp"
#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"

namespace gyrolog {

struct CurveRequest {
    std::string curve_path;
    std::string json_path;  // "-" is standard output; empty: not wanted
    std::string plot_path;
    std::string model_path;
    std::optional<double> rate_hz;  // of the model
    double confidence = 0.683;
    PaperSize paper{};  // of the plot
};

// Prints the report for people on `out`, unless the JSON goes there.
ExitCode analyze_curve_to_files(Console& console, const char* command, const CurveRequest& request);

}  // namespace gyrolog
