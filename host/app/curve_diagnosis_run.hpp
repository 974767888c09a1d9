// From a printed Allan curve and a model to what parts them.
#pragma once

#include <string>

#include "analysis/plot/paper_size.hpp"
#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"

namespace gyrolog {

struct CurveDiagnosisRequest {
    std::string curve_path;
    std::string model_path;  // empty: the file's own curves of a simulation are the model
    std::string json_path;   // "-" is standard output; empty: not wanted
    std::string plot_path;
    std::string model_out_path;  // the model with its coefficients as the curve has them
    PaperSize paper{};           // of the plot
    double horizon_s = 3600.0;   // of a simulator's file that it is: noise is nearest up to this
};

// Curves are of the axis that their name ends in: "x", "sensor_x". Prints the report for people on `out`,
// unless the JSON goes there.
ExitCode diagnose_curve_to_files(Console& console, const CurveDiagnosisRequest& request);

}  // namespace gyrolog
