#include "host/app/analysis_run.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "analysis/noise/analyze.hpp"
#include "analysis/simulate/fitted_model.hpp"
#include "host/app/analysis_plot.hpp"
#include "host/app/capture_report.hpp"
#include "host/app/command.hpp"
#include "host/app/figure_file.hpp"
#include "host/app/motion_refusal.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/progress_line.hpp"
#include "host/app/quantity.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/result_output.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/formats/analysis_json.hpp"
#include "host/formats/analysis_text.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {
namespace {

RecordingInput input_of(const AnalysisRequest& request) {
    RecordingInput input{request.recording_path, request.rate_hz, request.lsb_dps, request.on_stage};
    input.lsb_g = request.lsb_g;
    input.part = request.part;
    input.text = request.text;
    input.with_accelerometer = sensors_named(request.sensor) != Sensors::gyro;
    input.needs_gyro = sensors_named(request.sensor) == Sensors::gyro;
    return input;
}

std::string what_lacks(const AnalysisRequest& request) {
    switch (sensors_named(request.sensor)) {
        case Sensors::gyro:
            return "there is no angular rate to analyse";
        case Sensors::accelerometer:
            return no_accelerometer_text();
        case Sensors::all:
            break;
    }
    return "there is no angular rate and no specific force to analyse";
}

Result<AnalysisOptions> options_of(const AnalysisRequest& request) {
    AnalysisOptions options;
    options.confidence = request.confidence;
    options.kind = deviation_kind(request.deviation).value_or(options.kind);
    if (request.convention == name_of(PhaseConvention::matlab)) {
        options.convention = PhaseConvention::matlab;
    }
    options.every_m = request.factors == "all";
    if (!options.every_m && !request.factors.empty()) {
        GYROLOG_TRY(options.m, parse_whole_numbers(request.factors));
    }
    options.threads = std::max(1U, std::thread::hardware_concurrency());
    options.robust = request.robust;
    options.keep_temperature = request.keep_temperature;
    options.sensors = sensors_named(request.sensor);
    options.on_stage = request.on_stage;
    return options;
}

Status write_fitted_model(const AnalysisRequest& request, const Recording& recording,
                          const AnalysisReport& report) {
    if (report.axes.empty()) {
        return Error{
            ErrorCode::invalid_argument,
            "a model is of a gyro, with its accelerometer beside it: without the gyro there is none"};
    }
    if (report.unit.name == "lsb") {
        return Error{ErrorCode::invalid_argument,
                     "a model needs rates, and this recording has counts: give their scale with --lsb-dps"};
    }
    if (std::ranges::none_of(report.axes, [](const AxisReport& axis) {
            return axis.axis == "x" || axis.axis == "y" || axis.axis == "z";
        })) {
        return Error{ErrorCode::invalid_argument,
                     "a model is of one sensor with axes x, y and z, and this recording has none of them"};
    }
    GYROLOG_CHECK(refuse_motion(report, recording, request.recording_path, "model"));
    return write_model(fitted_model(report, recording), request.model_path);
}

// A figure for each sensor: an accelerometer beside a gyro has a file of its own, NAME.accelerometer.png.
void write_figures(ResultOutput& results, const AnalysisReport& report, const std::string& path,
                   const std::function<Status(SensorKind, const std::string&)>& write) {
    if (!report.axes.empty()) {
        results.file(path, [&] { return write(SensorKind::gyro, path); });
    }
    if (!report.accelerometer) { return; }
    std::string own = path;
    if (!report.axes.empty()) {
        own = second_figure(path);
        if (own.empty()) { return; }
    }
    results.file(own, [&] { return write(SensorKind::accelerometer, own); });
}

std::optional<double> mean_temperature_C(const Recording& recording) {
    const Column* column = recording.find("temp");
    if (column == nullptr) { return std::nullopt; }
    double sum_C = 0.0;
    std::size_t known = 0;
    for (std::size_t row = 0; row < column->size(); ++row) {
        const double value_C = column->value(row);
        if (!std::isfinite(value_C)) { continue; }
        sum_C += value_C;
        ++known;
    }
    return known == 0 ? std::nullopt : std::optional(sum_C / static_cast<double>(known));
}

RecordingFacts facts_of(const TimedRecording& read) {
    RecordingFacts facts;
    if (read.capture) {
        facts.board = board_name(*read.capture);
        facts.started = started_utc(*read.capture);
    }
    facts.temperature_C = mean_temperature_C(read.recording);
    return facts;
}

Status write_results(Console& console, const char* command, const AnalysisRequest& request,
                     const Recording& recording, const RecordingFacts& facts, const AnalysisReport& report) {
    ResultOutput results(console);
    request.on_stage("report");
    if (request.json_path != "-") { results.show(analysis_text(report)); }
    request.on_stage("json");
    results.text(request.json_path, [&] { return analysis_json(report, facts); });
    request.on_stage("plot");
    write_figures(results, report, request.plot_path, [&](SensorKind sensor, const std::string& path) {
        return write_analysis_plot(report, sensor, request.paper, path);
    });
    write_figures(results, report, request.histogram_path, [&](SensorKind sensor, const std::string& path) {
        return write_histogram_plot(report, recording, sensor, request.paper, path);
    });
    request.on_stage("model");
    if (!request.model_path.empty() && report.accelerometer && report.accelerometer->unit.is_counts()) {
        console.err << program_and(command)
                    << ": warning: the model is without the accelerometer, which has counts: give their "
                       "scale with --lsb-g\n";
    }
    results.file(request.model_path, [&] { return write_fitted_model(request, recording, report); });
    return results.finish();
}

}  // namespace

std::string second_figure(const std::string& path) {
    return is_figure_file(path) ? path_of_accelerometer(path) : std::string();
}

ExitCode analyze_to_files(Console& console, const char* command, const AnalysisRequest& request) {
    const NamedPath read[] = {{"RECORDING", request.recording_path}};
    const std::string second_plot = second_figure(request.plot_path);
    const std::string second_histogram = second_figure(request.histogram_path);
    const NamedPath written_paths[] = {{"--json", request.json_path},
                                       {"--plot", request.plot_path},
                                       {"--plot's figure of the accelerometer", second_plot},
                                       {"--histogram", request.histogram_path},
                                       {"--histogram's figure of the accelerometer", second_histogram},
                                       {"--model", request.model_path}};
    if (const Status fine = check_output_paths(read, written_paths); !fine.ok()) {
        return report_error(console, command, fine.error());
    }
    auto options = options_of(request);
    if (!options.ok()) { return report_error(console, command, options.error()); }
    std::optional<ProgressLine> progress(std::in_place, console);
    RecordingInput input = input_of(request);
    input.on_share = progress->of_reading();
    options->on_stage = StageObserver([&](const char* stage) {
        request.on_stage(stage);
        progress->show_analysis(stage);
    });
    auto read_in = read_timed_recording(input);
    if (!read_in.ok()) {
        progress.reset();
        report_error(console, command, read_in.error());
        return read_in.error().code == ErrorCode::invalid_argument ? ExitCode::usage : ExitCode::failed;
    }
    const RecordingFacts facts = facts_of(*read_in);
    read_in->capture.reset();
    const Recording& recording = read_in->recording;
    const AnalysisReport report = analyze(recording, *options);
    progress.reset();
    if (request.json_path == "-") {  // the report for people, which is not written then, has them too
        for (const std::string& warning : report.warnings) { say_warning(console, command, warning); }
    }
    if (!report.has_axes()) {
        return report_error(console, command,
                            {ErrorCode::failed, request.recording_path + ": " + what_lacks(request)});
    }
    const Status written = write_results(console, command, request, recording, facts, report);
    return written.ok() ? ExitCode::ok : report_error(console, command, written.error());
}

}  // namespace gyrolog
