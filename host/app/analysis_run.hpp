// From a recording's file to its report, plot and model.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/paper_size.hpp"
#include "analysis/recording/stage_observer.hpp"
#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"
#include "host/app/part_choice.hpp"
#include "host/app/text_options.hpp"

namespace gyrolog {

struct AnalysisRequest {
    std::string recording_path;
    std::string json_path;  // "-" is standard output; empty: not wanted
    std::string plot_path;
    std::string histogram_path;
    PaperSize paper{};  // of these two
    std::string model_path;
    std::string deviation = "overlapping";
    std::string convention = "sp1065";
    std::string factors;  // "1,10,100", or "all"; empty: the default list
    std::optional<double> rate_hz;
    std::optional<double> lsb_dps;
    std::optional<double> lsb_g{};
    PartChoice part{};
    TextChoice text{};
    std::string sensor = "all";  // or "gyro", "accelerometer"
    double confidence = 0.683;
    bool robust = false;
    bool keep_temperature = false;
    StageObserver on_stage{};  // of those of reading and analysing, then "json", "plot", "model", "report"
};

// Where the figure of an accelerometer beside a gyro goes; empty where a pipe takes one figure.
std::string second_figure(const std::string& path);

// Prints the report for people on `out`, unless the JSON goes there.
ExitCode analyze_to_files(Console& console, const char* command, const AnalysisRequest& request);

}  // namespace gyrolog
