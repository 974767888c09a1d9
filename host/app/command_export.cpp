#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "analysis/noise/analyze.hpp"
#include "host/app/command.hpp"
#include "host/app/model_help.hpp"
#include "host/app/motion_refusal.hpp"
#include "host/app/option_check.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/part_options.hpp"
#include "host/app/progress_line.hpp"
#include "host/app/quantity.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/base/file_output.hpp"
#include "host/base/printable.hpp"
#include "host/formats/export_format.hpp"
#include "host/formats/model_source.hpp"
#include "host/formats/simulators/simulator_format.hpp"
#include "host/formats/stops_text.hpp"

namespace gyrolog {
namespace {

constexpr const char* default_horizon = "1h";

struct ExportOptions {
    std::string source;
    std::string output;
    std::optional<double> rate_hz;
    std::optional<double> lsb_dps;
    std::optional<double> lsb_g;
    PartChoice part;
    TextChoice text{};
    std::string target;  // a simulator or a filter; empty: by the output's ending
    std::string horizon = default_horizon;
    std::uint64_t seed = 1;
    double inflate = 1.0;
    bool upper_limits = false;
};

std::string known_filters() {
    std::string names;
    for (const FilterFormat* format : filter_formats()) {
        names += (names.empty() ? "" : ", ") + std::string(format->name);
    }
    return names;
}

std::string known_simulators() {
    std::string names;
    for (const SimulatorFormat* format : simulator_formats()) {
        names += (names.empty() ? "" : ", ") + std::string(format->name);
    }
    return names;
}

std::vector<std::string> known_targets() {
    std::vector<std::string> names;
    for (const SimulatorFormat* format : simulator_formats()) { names.emplace_back(format->name); }
    for (const FilterFormat* format : filter_formats()) { names.emplace_back(format->name); }
    return names;
}

// The model, read at --rate where that is given; what was taken for granted is said.
Result<ModelSource> rated_model(Console& console, const ExportOptions& options) {
    GYROLOG_TRY(ModelSource source, read_model_source(options.source, options.seed));
    for (const std::string& note : source.file.notes) { console.err << "gyrolog export: " << note << '\n'; }
    if (options.rate_hz) {
        state_rate(source.file, *options.rate_hz);
    } else if (source.file.unstated.rate) {
        return Error{ErrorCode::malformed,
                     "model '" + options.source + "': rate_hz is missing: state it there, or give --rate"};
    }
    return source;
}

Status export_for_simulator(Console& console, const ExportOptions& options) {
    const SimulatorFormat* format = find_simulator_format(options.target);
    if (format == nullptr) {
        return invalid_argument("--for: there is no simulator or filter '" + options.target +
                                "'; there are the simulators " + known_simulators() + " and the filters " +
                                known_filters());
    }
    if (options.inflate != 1.0) {
        return invalid_argument("--inflate is for filters; a simulator is to have the noise that there is");
    }
    if (options.upper_limits) {
        return invalid_argument(
            "--upper-limits is for filters; a simulator is to have the noise that there is");
    }
    if (!is_model_file(options.source)) {
        return invalid_argument("--for needs a model: `gyrolog analyze " + options.source +
                                " --model MODEL.json` makes one of a recording");
    }
    GYROLOG_TRY(const double horizon_s, parse_duration_s(options.horizon));
    GYROLOG_TRY(const ModelSource source, rated_model(console, options));
    const SensorModel& model = source.file.model;
    if (horizon_s * model.rate_hz < 1.0) {
        return invalid_argument("--horizon: shorter than one sample of the model");
    }
    const std::string text = simulator_text(*format, model, source.name, horizon_s);
    return write_file(options.output, as_bytes(text));
}

std::string known_endings() {
    std::string endings;
    for (const ExportFormat& format : export_formats()) {
        endings += (endings.empty() ? "" : ", ") + std::string(format.ending);
    }
    return endings;
}

// What a filter would miss is said here as well: its file may be read by a program only.
Status write_noise(Console& console, const ExportOptions& options, const ExportFormat& format,
                   ExportSource source) {
    source.inflate = options.inflate;
    source.upper_limits = options.upper_limits;
    if (format.filter != nullptr) {
        if (const std::string keys = numbers_at_upper_limit(*format.filter, source); !keys.empty()) {
            console.err << "gyrolog export: warning: upper limits, not identified: " << keys << '\n';
        }
        for (const std::string& missing : missing_numbers(*format.filter, source)) {
            console.err << "gyrolog export: warning: left out: " << missing << '\n';
        }
    }
    return write_export(format, source, options.output);
}

Status export_model(Console& console, const ExportOptions& options, const ExportFormat& format) {
    if (format.needs != ExportFormat::Needs::noise) {
        return Error{ErrorCode::invalid_argument, "a model has no samples for a " +
                                                      std::string(format.ending) +
                                                      ": `gyrolog simulate` makes a recording of it"};
    }
    GYROLOG_TRY(const ModelSource source, rated_model(console, options));
    return write_noise(console, options, format, export_source(source.file.model, source.name));
}

bool has_rates(const Recording& recording) {
    return std::ranges::any_of(recording.columns, [](const Column& column) {
        return column.name.starts_with('g') && column.unit == "rad/s";
    });
}

bool has_rates_or_force(const Recording& recording) {
    return has_rates(recording) || std::ranges::any_of(recording.columns, [](const Column& column) {
               return column.name.starts_with('a') && column.unit == "m/s^2";
           });
}

Status export_recording(Console& console, const ExportOptions& options, const ExportFormat& format) {
    RecordingInput input{options.source, options.rate_hz, options.lsb_dps};
    input.part = options.part;
    input.text = options.text;
    input.lsb_g = options.lsb_g;
    input.needs_gyro = format.needs == ExportFormat::Needs::noise;
    input.instead_of_gyro = "this format is of a gyro's noise";
    std::optional<ProgressLine> progress(std::in_place, console);
    input.on_share = progress->of_reading();
    GYROLOG_TRY(const Recording recording, read_recording(input));
    progress.reset();
    for (const std::string& warning : recording.warnings) { say_warning(console, "export", warning); }
    if (const Stops stops = recording.stops(); stops.events > 0) {
        console.err << "gyrolog export: the recording was " << stops_text(stops.events, stops.s)
                    << "; what is written has a hole there\n";
    }
    ExportSource samples;
    samples.recording = &recording;
    if (format.needs == ExportFormat::Needs::samples) {
        progress.emplace(console);
        progress->show("writing");
        return format.write(samples, options.output);
    }
    if (input.needs_gyro ? !has_rates(recording) : !has_rates_or_force(recording)) {
        return Error{ErrorCode::invalid_argument,
                     options.source + ": there is no angular rate; give the scale of counts with --lsb-dps"};
    }
    AnalysisOptions analysis;
    analysis.threads = 0;
    analysis.sensors = format.sensors;
    analysis.keep_temperature = true;  // a filter that reads this does not know the temperature
    progress.emplace(console);
    analysis.on_stage = StageObserver([&](const char* stage) { progress->show_analysis(stage); });
    const AnalysisReport report = analyze(recording, analysis);
    progress.reset();
    const ExportSource source = export_source(recording, report);
    if (format.needs == ExportFormat::Needs::noise && source.gyro.empty()) {
        return Error{ErrorCode::failed, options.source + ": there is no gyro named gx, gy or gz"};
    }
    if (format.needs == ExportFormat::Needs::noise) {
        GYROLOG_CHECK(
            refuse_motion(report, recording, options.source, "noise parameters", {.touched_most = 0.0}));
    }
    return write_noise(console, options, format, source);
}

Status export_noise_or_samples(Console& console, const ExportOptions& options, const ExportFormat& format) {
    if (options.horizon != default_horizon) {
        return invalid_argument("--horizon is for simulators; a filter takes the terms as they are");
    }
    if (options.inflate != 1.0 && format.filter == nullptr) {
        return invalid_argument("--inflate is for filters: Kalibr's .yaml, and those of --for, " +
                                known_filters());
    }
    const bool is_model = is_model_file(options.source);
    if (options.upper_limits && (format.filter == nullptr || is_model)) {
        return invalid_argument("--upper-limits is for filters, of a recording; a model has no limits");
    }
    return is_model ? export_model(console, options, format) : export_recording(console, options, format);
}

ExitCode export_to_file(Console& console, const ExportOptions& options) {
    const NamedPath read[] = {{"RECORDING", options.source}};
    const NamedPath written[] = {{"--output", options.output}};
    if (const Status fine = check_output_paths(read, written); !fine.ok()) {
        return report_error(console, "export", fine.error());
    }
    const bool is_model = is_model_file(options.source);
    if (is_model && !options.part.is_whole()) {
        return report_error(console, "export",
                            {ErrorCode::invalid_argument,
                             "--from, --to and --still are for a recording; a model has no time"});
    }
    if (!options.target.empty()) {
        const FilterFormat* filter = find_filter_format(options.target);
        const Status done = filter != nullptr
                                ? export_noise_or_samples(console, options, export_format_of(*filter))
                                : export_for_simulator(console, options);
        if (!done.ok()) { return report_error(console, "export", done.error()); }
        console.notices() << "written: " << printable(options.output) << '\n';
        return ExitCode::ok;
    }
    const ExportFormat* format = export_format_of(options.output);
    if (format == nullptr) {
        return report_error(console, "export",
                            {ErrorCode::invalid_argument,
                             "'" + options.output + "' has none of the endings that tell the format: " +
                                 known_endings() + "; for another simulator or a filter, --for says which"});
    }
    const Status done = export_noise_or_samples(console, options, *format);
    if (!done.ok()) { return report_error(console, "export", done.error()); }
    console.notices() << "written: " << printable(options.output) << '\n';
    return ExitCode::ok;
}

}  // namespace

Action setup_export(CLI::App& app) {
    auto options = std::make_shared<ExportOptions>();
    app.add_option("RECORDING", options->source,
                   std::string("A capture (.pcapng), text (.csv, .csv.xz, ...), .mat or .npy, or a model: ") +
                       model_file_help)
        ->required();
    app.add_option(
           "-o,--output", options->output,
           "The format is told by the ending: .csv (.gz, .xz, .zst), .mat, .yaml (Kalibr), .m (MATLAB "
           "gyroparams), .tuning.json (Kalman filter)")
        ->type_name("FILE")
        ->required();
    CLI::Option* target =
        app.add_option(
               "--for", options->target,
               "Write the model as this simulator's own file, whatever the ending: " + known_simulators() +
                   "; or the noise of a recording or model as this filter takes it: " + known_filters())
            ->type_name("NAME")
            ->check(offered(known_targets()));
    app.add_option("--horizon", options->horizon,
                   "With --for and a simulator: averaging times up to this count where noise can only be "
                   "approximated")
        ->type_name("TIME")
        ->check(duration())
        ->needs(target)
        ->capture_default_str();
    app.add_option("--seed", options->seed, "With --for and a data sheet: another unit")->needs(target);
    app.add_option("--inflate", options->inflate,
                   "For filters: multiply all deviations and densities; the file's head says so")
        ->type_name("FACTOR")
        ->check(positive_number());
    app.add_flag("--upper-limits", options->upper_limits,
                 "For filters: what is not identified has its upper limit, and the file's head says so");
    app.add_option("--rate", options->rate_hz, "Sampling rate, in place of the one in the recording or model")
        ->type_name("HZ")
        ->check(sampling_rate());
    add_part_options(app, options->part);
    add_text_options(app, options->text);
    app.add_option("--lsb-dps", options->lsb_dps, lsb_dps_help)->type_name("DPS")->check(positive_number());
    app.add_option("--lsb-g", options->lsb_g, lsb_g_help)->type_name("G")->check(positive_number());
    return [options](Console& console) { return export_to_file(console, *options); };
}

}  // namespace gyrolog
