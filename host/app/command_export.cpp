#include <algorithm>
#include <filesystem>
#include <memory>

#include "analysis/noise/analyze.hpp"
#include "host/app/command.hpp"
#include "host/app/option_check.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/recording_input.hpp"
#include "host/formats/export_format.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/stops_text.hpp"

namespace gyrolog {
namespace {

struct ExportOptions {
    std::string source;
    std::string output;
    std::optional<double> rate_hz;
    std::optional<double> lsb_dps;
};

std::string known_endings() {
    std::string endings;
    for (const ExportFormat& format : export_formats()) {
        endings += (endings.empty() ? "" : ", ") + std::string(format.ending);
    }
    return endings;
}

Status export_model(const ExportOptions& options, const ExportFormat& format) {
    if (format.needs != ExportFormat::Needs::noise) {
        return Error{ErrorCode::invalid_argument, "a model has no samples for a " +
                                                      std::string(format.ending) +
                                                      ": `gyrolog simulate` makes a recording of it"};
    }
    GYROLOG_TRY(const SensorModel model, read_model(options.source));
    return format.write(export_source(model, std::filesystem::path(options.source).filename().string()),
                        options.output);
}

bool has_rates(const Recording& recording) {
    return std::ranges::any_of(recording.columns, [](const Column& column) {
        return column.name.starts_with('g') && column.unit == "rad/s";
    });
}

Status export_recording(Console& console, const ExportOptions& options, const ExportFormat& format) {
    GYROLOG_TRY(const Recording recording,
                read_recording({options.source, options.rate_hz, options.lsb_dps}));
    for (const std::string& warning : recording.warnings) {
        console.err << "gyrolog export: warning: " << warning << '\n';
    }
    if (const Stops stops = recording.stops(); stops.events > 0) {
        console.err << "gyrolog export: the recording was " << stops_text(stops.events, stops.s)
                    << "; what is written has a hole there\n";
    }
    ExportSource samples;
    samples.recording = &recording;
    if (format.needs == ExportFormat::Needs::samples) { return format.write(samples, options.output); }
    if (!has_rates(recording)) {
        return Error{ErrorCode::invalid_argument,
                     options.source + ": there is no angular rate; give the scale of counts with --lsb-dps"};
    }
    AnalysisOptions analysis;
    analysis.threads = 0;
    const AnalysisReport report = analyze(recording, analysis);
    const ExportSource source = export_source(recording, report);
    if (format.needs == ExportFormat::Needs::noise && source.gyro.empty()) {
        return Error{ErrorCode::failed, options.source + ": there is no gyro named gx, gy or gz"};
    }
    return format.write(source, options.output);
}

ExitCode export_to_file(Console& console, const ExportOptions& options) {
    const NamedPath read[] = {{"RECORDING", options.source}};
    const NamedPath written[] = {{"--output", options.output}};
    if (const Status fine = check_output_paths(read, written); !fine.ok()) {
        return report_error(console, "export", fine.error());
    }
    const ExportFormat* format = export_format_of(options.output);
    if (format == nullptr) {
        return report_error(
            console, "export",
            {ErrorCode::invalid_argument,
             "'" + options.output + "' has none of the endings that tell the format: " + known_endings()});
    }
    const Status done = options.source.ends_with(".json") ? export_model(options, *format)
                                                          : export_recording(console, options, *format);
    if (!done.ok()) { return report_error(console, "export", done.error()); }
    console.err << "written: " << options.output << '\n';
    return ExitCode::ok;
}

}  // namespace

Action setup_export(CLI::App& app) {
    auto options = std::make_shared<ExportOptions>();
    app.add_option("RECORDING", options->source,
                   "A capture (.pcapng), text (.csv, .csv.xz), or a model (.json)")
        ->required();
    app.add_option(
           "-o,--output", options->output,
           "The format is told by the ending: .csv (.gz, .xz, .zst), .mat, .yaml (Kalibr), .m (MATLAB "
           "gyroparams), .tuning.json (Kalman filter)")
        ->type_name("FILE")
        ->required();
    app.add_option("--rate", options->rate_hz, "Sampling rate, in place of the one in the file")
        ->type_name("HZ")
        ->check(number_from_to(1e-4, 1e7, "Hz"));
    app.add_option("--lsb-dps", options->lsb_dps, "Scale of gyro columns that are counts (_lsb)")
        ->type_name("DPS")
        ->check(positive_number());
    return [options](Console& console) { return export_to_file(console, *options); };
}

}  // namespace gyrolog
