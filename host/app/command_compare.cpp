#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/compare/comparison.hpp"
#include "analysis/plot/comparison_figure.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"
#include "analysis/simulate/known_motion.hpp"
#include "analysis/simulate/sensor_simulator.hpp"
#include "host/app/command.hpp"
#include "host/app/figure_file.hpp"
#include "host/app/many_recordings.hpp"
#include "host/app/model_help.hpp"
#include "host/app/option_check.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/part_options.hpp"
#include "host/app/progress_line.hpp"
#include "host/app/quantity.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/result_output.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/base/counted.hpp"
#include "host/formats/comparison_json.hpp"
#include "host/formats/comparison_text.hpp"
#include "host/formats/model_source.hpp"

namespace gyrolog {
namespace {

struct CompareRequest {
    std::string recording_path;
    std::string other_path;
    std::string json_path;  // "-" is standard output; empty: not wanted
    std::string plot_path;
    PaperSize paper{};
    std::string duration;  // of the recording's beginning; empty: all
    std::optional<double> rate_hz;
    std::optional<double> lsb_dps;
    std::optional<double> lsb_g;
    std::string sensor = "gyro";
    bool is_verbose = false;
    TextChoice text{};
    PartChoice part;  // of the recording, not of another one
    ModelComparisonOptions simulations;
};

SensorKind sensor_of(const CompareRequest& request) {
    return sensors_named(request.sensor) == Sensors::accelerometer ? SensorKind::accelerometer
                                                                   : SensorKind::gyro;
}

Result<Recording> comparable_recording(const CompareRequest& request, const std::string& path,
                                       const PartChoice& part) {
    RecordingInput input{path, request.rate_hz, request.lsb_dps};
    input.text = request.text;
    input.part = part;
    input.lsb_g = request.lsb_g;
    input.sensor = sensor_of(request);
    GYROLOG_TRY(Recording recording, read_recording(input));
    if (!request.duration.empty() && !recording.segments.empty()) {
        GYROLOG_TRY(const double duration_s, parse_duration_s(request.duration));
        recording = part_of(recording, {0.0, duration_s});
    }
    if (const auto refusal = comparison_refusal(recording)) {
        return Error{ErrorCode::failed, "'" + path + "': " + *refusal};
    }
    return recording;
}

// What reading a file had to say.
void tell_of_reading(Comparison& comparison, const std::string& path, std::span<const std::string> warnings) {
    for (const std::string& warning : warnings) {
        comparison.warnings.push_back(fmt::format("'{}': {}", path, warning));
    }
}

Result<Comparison> with_model(Console& console, const CompareRequest& request) {
    GYROLOG_TRY(ModelSource source, read_model_source(request.other_path, 1));
    ModelFile& file = source.file;
    if (file.is_drawn) {
        return Error{
            ErrorCode::unsupported,
            fmt::format("'{0}': a data sheet is no single sensor; draw a unit with `gyrolog simulate "
                        "{0} -o unit.csv --model-out unit.json` and compare with that",
                        request.other_path)};
    }
    if (const auto refusal = simulation_refusal(file.model)) {
        return Error{ErrorCode::failed, "model '" + request.other_path + "': " + *refusal};
    }
    GYROLOG_TRY(file, model_of_sensor(std::move(file), sensor_of(request), request.other_path));
    GYROLOG_TRY(Recording recording, comparable_recording(request, request.recording_path, request.part));
    const std::size_t of_reading = recording.warnings.size();
    recording = with_known_motion(std::move(recording));
    const std::vector<std::string> read(recording.warnings.begin(),
                                        recording.warnings.begin() + static_cast<std::ptrdiff_t>(of_reading));
    const std::vector<std::string> left_out(
        recording.warnings.begin() + static_cast<std::ptrdiff_t>(of_reading), recording.warnings.end());
    if (const auto refusal = comparison_refusal(recording)) {
        return Error{ErrorCode::failed, fmt::format("'{}': {}; {}", request.recording_path, *refusal,
                                                    fmt::join(left_out, "; "))};
    }
    complete_from(recording, file);
    ModelComparisonOptions options = request.simulations;
    std::optional<ProgressLine> progress(std::in_place, console);
    options.on_progress = [&](std::size_t done) {
        progress->show("simulating", static_cast<double>(done) / static_cast<double>(options.simulations));
        return true;
    };
    auto comparison = compare_with_model(std::make_shared<const Recording>(std::move(recording)), file.model,
                                         source.name, options);
    progress.reset();
    comparison->notes = file.notes;
    comparison->warnings.insert(comparison->warnings.begin(), left_out.begin(), left_out.end());
    tell_of_reading(*comparison, request.recording_path, read);
    return *std::move(comparison);
}

Result<Comparison> with_recording(const CompareRequest& request) {
    GYROLOG_TRY(const Recording recording,
                comparable_recording(request, request.recording_path, request.part));
    GYROLOG_TRY(const Recording other, comparable_recording(request, request.other_path, {}));
    Comparison comparison = compare_recordings(recording, other);
    if (comparison.axes.empty()) {
        return Error{ErrorCode::failed, "the two recordings have no axis in common"};
    }
    tell_of_reading(comparison, request.recording_path, recording.warnings);
    tell_of_reading(comparison, request.other_path, other.warnings);
    return comparison;
}

Status write_plot(const Comparison& comparison, const PaperSize& paper, const std::string& path) {
    return write_figure(render(ComparisonFigure{comparison, comparison_facts(comparison), paper}), path);
}

Status write_results(Console& console, const CompareRequest& request, const Comparison& comparison) {
    ResultOutput results(console);
    if (request.json_path != "-") {
        results.show_verdict(
            comparison_text(comparison, request.is_verbose ? Wording::whole : Wording::brief));
    } else {
        for (const std::string& warning : comparison.warnings) { say_warning(console, "compare", warning); }
    }
    results.text(request.json_path, [&] { return comparison_json(comparison); });
    results.file(request.plot_path, [&] { return write_plot(comparison, request.paper, request.plot_path); });
    return results.finish();
}

ExitCode compare_one(Console& console, const CompareRequest& request) {
    const NamedPath read[] = {{"RECORDING", request.recording_path}, {"WITH", request.other_path}};
    const NamedPath outputs[] = {{"--json", request.json_path}, {"--plot", request.plot_path}};
    if (const Status fine = check_output_paths(read, outputs); !fine.ok()) {
        return report_error(console, "compare", fine.error());
    }
    Result<Comparison> comparison =
        is_model_file(request.other_path) ? with_model(console, request) : with_recording(request);
    if (!comparison.ok()) { return report_error(console, "compare", comparison.error()); }
    if (sensor_of(request) == SensorKind::accelerometer) {
        comparison->unit = unit_of_accelerometer_as_gyro();
    }
    const Status written = write_results(console, request, *comparison);
    return written.ok() ? ExitCode::ok : report_error(console, "compare", written.error());
}

// The last word is what to compare with.
ExitCode compare(Console& console, CompareRequest request, ManyRecordings many) {
    if (many.recordings.size() < 2) {
        return report_error(console, "compare",
                            {ErrorCode::invalid_argument,
                             "WITH is required: a sensor model or another recording, after the "
                             "recording"});
    }
    request.other_path = many.recordings.back();
    many.recordings.pop_back();
    const NamedPath read[] = {{"WITH", request.other_path}};
    const NamedPath written[] = {{"--plot", request.plot_path}};
    const auto run = [&](Console& own, const std::string& recording, bool as_line) {
        request.recording_path = recording;
        if (as_line) { request.json_path = "-"; }
        return compare_one(own, request);
    };
    return run_on_recordings(console, "compare", many, {read, written}, run);
}

}  // namespace

Action setup_compare(CLI::App& app) {
    auto request = std::make_shared<CompareRequest>();
    auto many = std::make_shared<ManyRecordings>();
    app.add_option("--plot", request->plot_path, "Draw both side by side")
        ->type_name(figure_file_type)
        ->check(figure_file());
    add_paper_options(app, request->paper);
    app.add_option("--json", request->json_path, "Write the comparison as JSON (- for standard output)")
        ->type_name("FILE");
    add_recordings(
        app, *many, "RECORDING",
        std::string("A capture (.pcapng), text (.csv, .csv.xz, ...), .mat or .npy, and last of all WITH "
                    "what: a sensor model, which is simulated, or another recording. A model is ") +
            model_file_help)
        ->type_name("WITH")
        ->required();
    app.add_option("--simulations", request->simulations.simulations,
                   "How many simulations make the band: of 39 their extremes hold 95 %, more are smoother")
        ->check(whole_number(simulations_min, 10'000))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--seed", request->simulations.seed, "Other simulations of the same kind")
        ->type_name("N")
        ->check(whole_number(0))
        ->capture_default_str();
    app.add_option("--duration", request->duration, "Compare the first part of a recording only")
        ->type_name("T")
        ->check(duration());
    app.add_option("--rate", request->rate_hz, "Sampling rate of recordings, in place of the one in the file")
        ->type_name("HZ")
        ->check(sampling_rate());
    add_part_options(app, request->part);
    add_text_options(app, request->text);
    app.add_option("--lsb-dps", request->lsb_dps, lsb_dps_help)->type_name("DPS")->check(positive_number());
    app.add_option("--lsb-g", request->lsb_g, lsb_g_help)->type_name("G")->check(positive_number());
    app.add_option("--sensor", request->sensor, "Which sensor: gyro, or accelerometer (at rest)")
        ->check(CLI::IsMember({"gyro", "accelerometer"}))
        ->type_name("SENSOR")
        ->capture_default_str();
    app.add_flag("--verbose", request->is_verbose, "Also say where each axis lies outside, place by place");
    return [request, many](Console& console) { return compare(console, *request, *many); };
}

}  // namespace gyrolog
