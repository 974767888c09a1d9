// From a recording and a model to what parts them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/noise/sensor_unit.hpp"
#include "analysis/plot/paper_size.hpp"
#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"
#include "host/app/part_choice.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/text_options.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

struct RecordingDiagnosisRequest {
    std::string recording_path;
    std::string model_path;                // empty: a plain model of the recording's own (plain_model.hpp)
    std::vector<std::string> asked_paths;  // of effects that a person describes
    std::string holdout_path;              // a second recording, on which the gap is measured; empty: none
    std::string json_path;                 // "-" is standard output; empty: not wanted
    std::string plot_path;
    PaperSize paper{};           // of the plot
    std::string model_out_path;  // the model with the causes added
    double horizon_s = 3600.0;   // of a simulator's file that it is: noise is nearest up to this
    bool is_verbose = false;
    bool with_unnamed = false;      // and what was modelled without a name
    std::optional<double> rate_hz;  // in place of the one in the file
    std::optional<double> lsb_dps;
    std::optional<double> lsb_g{};
    Sensors sensors = Sensors::gyro;
    UnitChoice unit{};  // of an array
    PartChoice part{};  // of the recording, not of the second one
    TextChoice text{};
    std::size_t average = 1;  // samples of which means are looked at
    std::size_t simulations = 200;
    std::uint64_t seed = 1;
    unsigned threads = 0;  // 0: all processors
};

// Reads, diagnoses one sensor of those that are wanted and shows the progress; writes nothing.
Result<Diagnosis> diagnose_recording(Console& console, const RecordingDiagnosisRequest& request,
                                     SensorKind sensor = SensorKind::gyro);

// How it was looked at, and how large the causes are: below the title of the figure.
std::vector<std::string> diagnosis_facts(const Diagnosis& diagnosis);

// Prints the report for people on `out`, unless the JSON goes there.
ExitCode diagnose_recording_to_files(Console& console, const RecordingDiagnosisRequest& request);

}  // namespace gyrolog
