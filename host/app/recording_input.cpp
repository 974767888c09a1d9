#include "host/app/recording_input.hpp"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "host/base/counted.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/session/load_capture.hpp"

namespace gyrolog {
namespace {

Result<TimedRecording> read_capture(const RecordingInput& input) {
    GYROLOG_TRY(LoadedCapture capture,
                load_capture(input.path, true, input.on_stage,
                             {input.samples_most, input.samples_per_row, input.with_accelerometer}));
    input.on_stage("place");
    auto recording = capture.decoder->take_recording(std::filesystem::path(input.path).filename().string());
    if (!recording.ok()) { return in_context("read '" + input.path + "'", std::move(recording).error()); }
    if (capture.file.blocks.end == FileEnd::damaged) {
        recording->warnings.push_back(
            fmt::format("the file is damaged in {}; the samples lost there count as missing",
                        counted(capture.file.blocks.damaged_ranges, "place")));
    }
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

}  // namespace

Result<Recording> read_recording(const RecordingInput& input) {
    GYROLOG_TRY(TimedRecording timed, read_timed_recording(input));
    return std::move(timed.recording);
}

namespace {

Result<TimedRecording> read_whole(const RecordingInput& input) {
    if (looks_like_capture(input.path)) { return read_capture(input); }
    input.on_stage("read");
    CsvReadOptions options;
    options.rate_hz = input.rate_hz;
    options.lsb_dps = input.lsb_dps;
    options.allow_unscaled_counts = true;
    options.rows_most = input.samples_most;
    options.samples_per_row = input.samples_per_row;
    options.lsb_g = input.lsb_g;
    options.with_accelerometer = input.with_accelerometer;
    options.needs_gyro = input.needs_gyro;
    GYROLOG_TRY(Recording recording, read_recording_csv(input.path, options));
    return TimedRecording{std::move(recording)};
}

}  // namespace

Result<TimedRecording> read_timed_recording(const RecordingInput& input) {
    if (input.part.is_whole()) { return read_whole(input); }
    RecordingInput all = input;
    all.samples_most = RecordingInput{}.samples_most;
    GYROLOG_TRY(TimedRecording timed, read_whole(all));
    if (timed.host_start_s) {
        GYROLOG_TRY(const TimeSpan span, chosen_span(timed.recording, input.part, input.path));
        *timed.host_start_s += span.from_s;
    }
    GYROLOG_TRY(timed.recording, take_part(std::move(timed.recording), input.part, input.path));
    return timed;
}

Result<RecordingInput> with_known_part(RecordingInput input) {
    if (!input.part.is_still) { return input; }
    RecordingInput all = input;
    all.part = {};
    all.samples_most = RecordingInput{}.samples_most;
    GYROLOG_TRY(const Recording recording, read_recording(all));
    GYROLOG_TRY(const TimeSpan span, chosen_span(recording, input.part, input.path));
    input.part = {span.from_s, span.to_s, false};
    return input;
}

}  // namespace gyrolog
