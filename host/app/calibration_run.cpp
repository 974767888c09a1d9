#include "host/app/calibration_run.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/calibrate/calibrated_model.hpp"
#include "analysis/calibrate/calibration.hpp"
#include "analysis/noise/sensor_columns.hpp"
#include "host/app/command.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/result_output.hpp"
#include "host/base/printable.hpp"
#include "host/formats/calibration_ardupilot.hpp"
#include "host/formats/calibration_c_header.hpp"
#include "host/formats/calibration_json.hpp"
#include "host/formats/calibration_px4.hpp"
#include "host/formats/calibration_text.hpp"
#include "host/formats/json.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {
namespace {

CalibrationOptions options_of(const CalibrationRequest& request) {
    CalibrationOptions options;
    if (request.turn_deg) { options.observations.turn_rad = *request.turn_deg * rad_per_deg; }
    if (request.turn_sd_deg) { options.observations.turn_sd_rad = *request.turn_sd_deg * rad_per_deg; }
    if (request.gravity_m_s2) { options.accelerometer.gravity_m_s2 = *request.gravity_m_s2; }
    return options;
}

// Counts whose scale nobody told would be taken for a sensor that is not there.
Status check_scales(const Recording& recording, const std::string& path) {
    for (const Column& column : recording.columns) {
        const bool is_gyro = column.name.starts_with('g');
        if (column.unit != "lsb" || (!is_gyro && !column.name.starts_with('a'))) { continue; }
        return Error{ErrorCode::failed, fmt::format("'{}': {} is in counts; say how much one is with {}",
                                                    path, column.name, is_gyro ? "--lsb-dps" : "--lsb-g")};
    }
    return {};
}

// A calibration is of one sensor of each kind.
Status check_single(const Recording& recording, const std::string& path) {
    std::string numbered;
    for (const Column& column : recording.columns) {
        const bool is_sensor = is_of(SensorKind::gyro, column) || is_of(SensorKind::accelerometer, column);
        if (!is_sensor) { continue; }
        if (column.name.size() == 2) { return {}; }
        if (numbered.empty()) { numbered = column.name; }
    }
    if (numbered.empty()) { return {}; }
    return invalid_argument(fmt::format(
        "'{}' is of an array ({} ...), and a calibration is of one unit: choose it with --columns, "
        "such as t,gx,gy,gz,ax,ay,az and _ for what is left out",
        path, numbered));
}

Result<std::vector<Recording>> read_recordings(const CalibrationRequest& request) {
    std::vector<Recording> recordings;
    for (const std::string& path : request.recordings) {
        RecordingInput input;
        input.path = path;
        input.rate_hz = request.rate_hz;
        input.lsb_dps = request.lsb_dps;
        input.lsb_g = request.lsb_g;
        input.text = request.text;
        input.needs_gyro = false;
        GYROLOG_TRY(Recording recording, read_recording(input));
        GYROLOG_CHECK(check_single(recording, path));
        GYROLOG_CHECK(check_scales(recording, path));
        recordings.push_back(std::move(recording));
    }
    return recordings;
}

std::string refusal_of(const Calibration& calibration) {
    std::string text =
        fmt::format("'{}'{}: nothing but a gyro's bias can be said", calibration.recordings.front(),
                    calibration.recordings.size() > 1 ? " and the others" : "");
    if (calibration.phases.rests.empty() && !calibration.has_reference) {
        text = fmt::format(
            "'{}': no rest was found; let the sensor lie still for two seconds or more between "
            "moves",
            calibration.recordings.front());
    }
    return text;
}

// In lines of its own: an error is one clause.
ExitCode refuse(Console& console, const Calibration& calibration) {
    const ExitCode code =
        report_error(console, "calibrate", Error{ErrorCode::failed, refusal_of(calibration)});
    console.err << undetermined_text(calibration);
    for (const std::string& warning : calibration.warnings) {
        say_warning(console, "calibrate", printable(warning));
    }
    return code;
}

Status check_paths(const CalibrationRequest& request) {
    for (std::size_t i = 0; i < request.recordings.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (!same_file(request.recordings[j], request.recordings[i])) { continue; }
            return Error{ErrorCode::invalid_argument,
                         fmt::format("'{}' and '{}' are the same recording: it would count twice",
                                     request.recordings[j], request.recordings[i])};
        }
    }
    std::vector<NamedPath> read;
    for (const std::string& path : request.recordings) { read.push_back({"RECORDING", path}); }
    const NamedPath outputs[] = {{"--json", request.json_path},
                                 {"--model-out", request.model_path},
                                 {"--px4", request.px4_path},
                                 {"--ardupilot", request.ardupilot_path},
                                 {"--header", request.header_path}};
    return check_output_paths(read, outputs);
}

Status write_results(Console& console, const CalibrationRequest& request, const Calibration& calibration,
                     const Recording& recording) {
    ResultOutput results(console);
    if (request.json_path != "-") {
        results.show(calibration_text(calibration));
    } else {
        for (const std::string& warning : calibration.warnings) {
            say_warning(console, "calibrate", warning);
        }
    }
    results.json(request.json_path, [&] { return calibration_json(calibration); });
    results.file(request.model_path,
                 [&] { return write_model(calibrated_model(calibration, recording), request.model_path); });
    results.text(request.px4_path, [&] { return px4_parameters(calibration); });
    results.text(request.ardupilot_path, [&] { return ardupilot_parameters(calibration); });
    results.text(request.header_path, [&] { return calibration_c_header(calibration); });
    return results.finish();
}

}  // namespace

ExitCode run_calibration(Console& console, const CalibrationRequest& request) {
    if (const Status fine = check_paths(request); !fine.ok()) {
        return report_error(console, "calibrate", fine.error());
    }
    Result<std::vector<Recording>> recordings = read_recordings(request);
    if (!recordings.ok()) { return report_error(console, "calibrate", recordings.error()); }
    const Recording first = recordings->front();
    const Calibration calibration = calibrate(*std::move(recordings), options_of(request));
    if (request.turn_deg && !calibration.has_accelerometer) {
        return report_error(
            console, "calibrate",
            Error{ErrorCode::failed,
                  "--turn needs an accelerometer with three axes, which tells the turn's axis; "
                  "without one, record a reference rate (ref_x_dps ref_y_dps ref_z_dps)"});
    }
    if (!calibration.determines_anything()) { return refuse(console, calibration); }
    const Status written = write_results(console, request, calibration, first);
    return written.ok() ? ExitCode::ok : report_error(console, "calibrate", written.error());
}

}  // namespace gyrolog
