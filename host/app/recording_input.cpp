#include "host/app/recording_input.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "analysis/denoise/array_reference.hpp"
#include "analysis/noise/noise_model.hpp"
#include "analysis/noise/sensor_columns.hpp"
#include "analysis/simulate/recorded_orientation.hpp"
#include "host/app/motion_refusal.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/base/counted.hpp"
#include "host/formats/recording_file.hpp"
#include "host/session/load_capture.hpp"

namespace gyrolog {
namespace {

// Empty: nothing. Who reads a part only does not see the end.
std::string what_is_wrong_with_the_end(const LoadedCapture& capture, const RecordingInput& input) {
    const BlockAccounts& blocks = capture.file.blocks;
    if (blocks.only_behind_close()) {
        return fmt::format("{} behind the end of the capture, which its writer had closed: they are left out",
                           counted(blocks.bytes_behind_close, "byte"));
    }
    if (blocks.end == FileEnd::damaged) {
        return fmt::format("the file is damaged in {}; the samples lost there count as missing",
                           counted(blocks.damaged_ranges, "place"));
    }
    if (input.samples_most != RecordingInput{}.samples_most) { return {}; }
    if (blocks.end == FileEnd::torn_tail) {
        return "the file ends in a torn tail: its writer died there, and what came after it is not here";
    }
    if (!capture.closed_by_writer()) {
        return "the writer did not close the file: it was stopped short, or is still at work";
    }
    return {};
}

// What `check` counts as missing and no hole between samples shows.
void warn_of_missing_ends(Recording& recording, const LinkReport& report, double rate_hz) {
    const auto warn = [&](std::uint64_t samples, const char* place, const char* end) {
        if (samples == 0) { return; }
        recording.warnings.push_back(
            fmt::format("the capture {} {:.3g} s {} sample: {} missing there", place,
                        static_cast<double>(samples) / rate_hz, end,
                        samples == 1 ? "1 sample is" : counted(samples, "sample") + " are"));
    };
    warn(report.samples_missing_at_start, "begins", "before its first");
    warn(report.samples_missing_at_end, "goes on for", "behind its last");
}

bool has_sensor(SensorKind sensor, const Recording& recording) {
    return std::ranges::any_of(recording.columns,
                               [&](const Column& column) { return is_of(sensor, column); });
}

Status check_gyro(const Recording& recording, const RecordingInput& input) {
    if (!input.needs_gyro || input.sensor != SensorKind::gyro || has_sensor(SensorKind::gyro, recording) ||
        !has_sensor(SensorKind::accelerometer, recording)) {
        return {};
    }
    return invalid_argument(
        fmt::format("'{}' has an accelerometer and no gyro: {}", input.path, input.instead_of_gyro));
}

// Text without a gyro is refused before it is known what else it holds.
Error without_gyro(Error error, const RecordingInput& input, RecordingReadOptions options) {
    if (!options.needs_gyro) { return error; }
    options.needs_gyro = false;
    options.with_accelerometer = true;
    options.samples_per_row = 1;
    options.rows_most = 2;
    const auto beginning = read_recording_file(input.path, options);
    if (!beginning.ok()) { return error; }
    Status gyro = check_gyro(*beginning, input);
    return gyro.ok() ? error : std::move(gyro).error();
}

// A scale that nothing is scaled by was meant for something.
void warn_of_unused_scales(Recording& recording, const RecordingInput& input, const std::string& why) {
    const auto has_counts = [&](SensorKind sensor) {
        return why.empty() && std::ranges::any_of(recording.columns, [&](const Column& column) {
                   return is_of(sensor, column) && column.source_unit == "lsb";
               });
    };
    const auto warn = [&](const char* option, const char* sensor) {
        recording.warnings.push_back(
            fmt::format("{} is ignored: {}", option,
                        why.empty() ? fmt::format("no {} column holds counts", sensor) : why));
    };
    if (input.lsb_dps && !has_counts(SensorKind::gyro)) { warn("--lsb-dps", "gyro"); }
    if (input.lsb_g && input.with_accelerometer && !has_counts(SensorKind::accelerometer)) {
        warn("--lsb-g", "accelerometer");
    }
}

Result<TimedRecording> read_capture(const RecordingInput& input) {
    GYROLOG_TRY(
        LoadedCapture capture,
        load_capture(input.path, true, input.on_stage,
                     {input.samples_most, input.samples_per_row, input.with_accelerometer}, input.on_share));
    input.on_stage("place");
    auto recording = capture.decoder->take_recording(std::filesystem::path(input.path).filename().string());
    if (!recording.ok()) { return in_context("read '" + input.path + "'", std::move(recording).error()); }
    GYROLOG_CHECK(check_gyro(*recording, input));
    const std::string hurt = what_is_wrong_with_the_end(capture, input);
    if (!hurt.empty()) { recording->warnings.push_back(hurt); }
    for (const std::string& contradiction : capture.contradictions()) {
        recording->warnings.push_back(contradiction + ": how much is missing is not certain");
    }
    if (input.samples_most == RecordingInput{}.samples_most) {
        warn_of_missing_ends(*recording, capture.decoder->report(),
                             recording->rate_hz * static_cast<double>(input.samples_per_row));
    }
    const TextChoice& text = input.text;
    if (!text.columns.empty() || !text.gyro_unit.empty() || !text.accelerometer_unit.empty()) {
        recording->warnings.emplace_back(
            "--columns, --unit and --acc-unit are ignored: a capture says itself what it holds");
    }
    warn_of_unused_scales(*recording, input, "a capture says itself what its counts are");
    if (input.rate_hz) {
        const double told_hz = recording->rate_hz * static_cast<double>(input.samples_per_row);
        if (std::abs(*input.rate_hz / told_hz - 1.0) > 1e-3) {
            recording->warnings.push_back(
                fmt::format("the rate is taken as {:g} Hz, as given; the board's clock says {:.6g} Hz",
                            *input.rate_hz, told_hz));
        }
        recording->nominal_rate_hz.reset();
        recording->rate_hz = *input.rate_hz / static_cast<double>(input.samples_per_row);
        recording->rate_sd_hz.reset();
    }
    const std::optional<double> host_start_s = capture.decoder->recording_host_start_s();
    return TimedRecording{std::move(recording).value(), host_start_s, std::move(capture)};
}

// Of the gyros that put out counts the widest range: ST LSM6DSV, TDK ICM-45686. With 12 bits or more a count
// of such a gyro is below 2 deg/s.
constexpr double widest_range_dps = 4000.0;
constexpr double coarsest_count_dps = 2.0;

struct Moments {
    double mean_dps;
    double sd_dps;
};

Moments moments_of(const Column& column) {
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < column.size(); ++i) {
        const double dps = column.value(i) * deg_per_rad;
        sum += dps;
        squares += dps * dps;
    }
    const auto count = static_cast<double>(column.size());
    const double mean_dps = sum / count;
    return {mean_dps, std::sqrt(std::max(squares / count - mean_dps * mean_dps, 0.0))};
}

// Data sheets give the sensitivity, in counts per deg/s; the option takes its inverse.
Status check_scale(Recording& recording, double lsb_dps, const std::string& path) {
    const std::string meant =
        lsb_dps > 1.0 ? fmt::format("; a data sheet's {0:g} LSB per deg/s is --lsb-dps {1:.6g} (1/{0:g})",
                                    lsb_dps, 1.0 / lsb_dps)
                      : "";
    bool any_counts = false;
    for (const Column& column : recording.columns) {
        if (column.source_unit != "lsb" || column.unit != "rad/s" || column.size() == 0) { continue; }
        any_counts = true;
        const Moments moments = moments_of(column);
        const bool is_mean = std::abs(moments.mean_dps) > widest_range_dps;
        if (!is_mean && moments.sd_dps <= widest_range_dps) { continue; }
        return invalid_argument(
            fmt::format("'{}': with --lsb-dps {:g}, deg/s per count, the {} of {} is {:.4g} deg/s, and no "
                        "gyro that puts out "
                        "counts reaches {:g}{}",
                        path, lsb_dps, is_mean ? "mean" : "standard deviation", column.name,
                        is_mean ? moments.mean_dps : moments.sd_dps, widest_range_dps, meant));
    }
    if (any_counts && lsb_dps > coarsest_count_dps) {
        recording.warnings.push_back(
            fmt::format("--lsb-dps {:g} makes each count {:g} deg/s, coarser than any gyro's{}", lsb_dps,
                        lsb_dps, meant));
    }
    return {};
}

Result<Recording> take_unit(Recording recording, const UnitChoice& choice, const std::string& path) {
    if (!choice.unit) { return recording; }
    UnitOfArray taken = choice.is_against_others ? unit_against_others(recording, *choice.unit)
                                                 : unit_of_array(recording, *choice.unit);
    if (taken.failure.empty()) { return std::move(taken.recording); }
    return Error{ErrorCode::failed, fmt::format("'{}' {}", path, taken.failure)};
}

}  // namespace

Result<Recording> read_recording(const RecordingInput& input) {
    GYROLOG_TRY(TimedRecording timed, read_timed_recording(input));
    if (!input.in_known_poses || input.sensor == SensorKind::gyro || !has_orientation(timed.recording)) {
        GYROLOG_TRY(Recording recording,
                    recording_of_sensor(std::move(timed.recording), input.sensor, input.path));
        return take_unit(std::move(recording), input.unit, input.path);
    }
    GYROLOG_TRY(Recording seen, recording_of_sensor(timed.recording, input.sensor, input.path));
    if (!is_moved(seen)) { return seen; }
    return accelerometer_in_poses(std::move(timed.recording), input.path);
}

namespace {

Result<TimedRecording> read_whole(const RecordingInput& input) {
    if (looks_like_capture(input.path)) { return read_capture(input); }
    input.on_stage("read");
    RecordingReadOptions options;
    options.rate_hz = input.rate_hz;
    options.lsb_dps = input.lsb_dps;
    options.allow_unscaled_counts = true;
    options.rows_most = input.samples_most;
    options.samples_per_row = input.samples_per_row;
    options.lsb_g = input.lsb_g;
    options.with_accelerometer = input.with_accelerometer;
    options.needs_gyro = input.needs_gyro && input.sensor == SensorKind::gyro;
    options.choice = input.text;
    auto read = read_recording_file(input.path, options);
    if (!read.ok()) { return without_gyro(std::move(read).error(), input, options); }
    Recording recording = std::move(read).value();
    if (input.lsb_dps) { GYROLOG_CHECK(check_scale(recording, *input.lsb_dps, input.path)); }
    warn_of_unused_scales(recording, input, "");
    return TimedRecording{std::move(recording)};
}

}  // namespace

Result<TimedRecording> read_timed_recording(const RecordingInput& input) {
    if (input.part.is_whole()) { return read_whole(input); }
    RecordingInput all = input;
    all.samples_most = RecordingInput{}.samples_most;
    GYROLOG_TRY(TimedRecording timed, read_whole(all));
    timed.host_start_s.reset();
    GYROLOG_TRY(timed.recording, take_part(std::move(timed.recording), input.part, input.path));
    return timed;
}

Result<RecordingInput> with_known_part(RecordingInput input) {
    if (!input.part.is_still) { return input; }
    RecordingInput all = input;
    all.part = {};
    all.samples_most = RecordingInput{}.samples_most;
    GYROLOG_TRY(const TimedRecording timed, read_timed_recording(all));
    const Recording& recording = timed.recording;
    GYROLOG_TRY(const TimeSpan span, chosen_span(recording, input.part, input.path));
    input.part = {span.from_s, span.to_s, false};
    return input;
}

}  // namespace gyrolog
