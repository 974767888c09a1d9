#include "host/app/array_input.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "analysis/denoise/array_columns.hpp"
#include "host/app/device_choice.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/decode/stream_decoder.hpp"
#include "host/session/open_source.hpp"
#include "host/transport/source_uri.hpp"
#include "host/virtual_board/sim_options.hpp"

namespace gyrolog {
namespace {

bool is_simulated(const std::string& path) { return path.starts_with("sim:"); }

// Decodes what a source tells, in the source's thread, until it ends.
class DecodingSink final : public TransferSink {
public:
    bool on_transfer(const Transfer& transfer) override {
        static_cast<void>(decoder_.take(transfer));
        return true;
    }
    void on_end(SourceEnd /*end*/, const std::optional<Error>& error) override {
        const std::lock_guard lock(mutex_);
        error_ = error;
        ended_ = true;
        changed_.notify_all();
    }
    Status wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return ended_; });
        return error_ ? Status(*error_) : Status();
    }
    StreamDecoder& decoder() { return decoder_; }

private:
    StreamDecoder decoder_{{.keep_samples = true}};
    std::mutex mutex_;
    std::condition_variable changed_;
    bool ended_ = false;
    std::optional<Error> error_;
};

Result<Recording> simulated_board(const std::string& uri, double seconds) {
    DecodingSink sink;  // outlives the source, whose thread calls it
    GYROLOG_TRY(OpenedSource opened, open_source(uri, {seconds, std::nullopt}, false));
    GYROLOG_CHECK(opened.source->start(sink));
    Status streamed = opened.source->set_line_state(true);
    if (streamed.ok()) { streamed = sink.wait(); }
    opened.source->stop();
    if (!streamed.ok()) { return in_context(uri, std::move(streamed).error()); }
    return sink.decoder().take_recording(uri);
}

// One after the other; all begin at device time 0.
Result<std::vector<TimedRecording>> simulated_boards(const std::string& uri, double seconds) {
    GYROLOG_TRY(const SourceUri parsed, parse_source_uri(uri));
    GYROLOG_TRY(const SimOptions options, parse_sim_options(parsed.options));
    if (options.realtime) {
        return Error{
            ErrorCode::invalid_argument,
            "'" + uri + "': a virtual array is simulated as fast as it can be; leave realtime=1 out"};
    }
    std::vector<TimedRecording> boards;
    for (unsigned board = 1; board <= options.boards; ++board) {
        std::string one = "sim:" + options.text + (options.text.empty() ? "" : ",");
        one += "boards=" + std::to_string(options.boards) + ",board=" + std::to_string(board);
        GYROLOG_TRY(Recording recording, simulated_board(one, seconds));
        boards.push_back({std::move(recording), std::nullopt});
    }
    return boards;
}

double start_s(const TimedRecording& timed, const ArrayInput& input) {
    const Recording& recording = timed.recording;
    if (input.align_starts || recording.segments.empty()) { return 0.0; }
    if (recording.stamps == StampKind::sampling && !recording.t_s.empty()) {
        return recording.t_s.front() -
               static_cast<double>(recording.segments.front().first_index) / recording.rate_hz;
    }
    return timed.host_start_s.value_or(0.0);
}

Status check_clocks(const std::vector<TimedRecording>& recordings) {
    const auto is_capture = [](const TimedRecording& r) { return r.host_start_s.has_value(); };
    if (std::ranges::all_of(recordings, is_capture)) { return {}; }
    const auto has_stamps = [](const TimedRecording& r) {
        return r.recording.stamps == StampKind::sampling && !r.recording.t_s.empty();
    };
    if (std::ranges::all_of(recordings, has_stamps)) { return {}; }
    return Error{
        ErrorCode::invalid_argument,
        "the recordings do not all have the same kind of clock (captures by one host, or time stamps "
        "that mark sampling instants): --align start lays their first samples on each other"};
}

}  // namespace

std::vector<std::string> files_of_array(const ArrayInput& input) {
    std::vector<std::string> files;
    for (const std::string& path : input.paths) {
        files.push_back(is_simulated(path) ? file_of_device(path) : path);
    }
    return files;
}

Result<Recording> read_array(const ArrayInput& input) {
    ArrayInput aligned = input;
    std::vector<TimedRecording> recordings;
    for (const std::string& path : input.paths) {
        if (is_simulated(path)) {
            if (input.paths.size() > 1) {
                return Error{ErrorCode::invalid_argument,
                             "'" + path + "' is an array of its own; give it alone, with boards=N"};
            }
            GYROLOG_TRY(recordings, simulated_boards(path, input.simulated_s));
            for (TimedRecording& timed : recordings) {
                GYROLOG_TRY(timed.recording,
                            recording_of_sensor(std::move(timed.recording), input.sensor, path));
            }
            aligned.align_starts = true;
            break;
        }
        RecordingInput file{path, input.rate_hz, input.lsb_dps};
        file.text = input.text;
        file.lsb_g = input.lsb_g;
        file.sensor = input.sensor;
        GYROLOG_TRY(TimedRecording timed, read_timed_recording(file));
        GYROLOG_TRY(timed.recording, recording_of_sensor(std::move(timed.recording), input.sensor, path));
        recordings.push_back(std::move(timed));
    }
    if (recordings.size() == 1) { return std::move(recordings.front().recording); }
    if (!aligned.align_starts) { GYROLOG_CHECK(check_clocks(recordings)); }
    std::vector<ArrayMember> members;
    members.reserve(recordings.size());
    for (const TimedRecording& timed : recordings) {
        members.push_back({&timed.recording, start_s(timed, aligned)});
    }
    JoinedArray joined = join_recordings(members);
    if (!joined.failure.empty()) {
        std::string advice;
        if (!aligned.align_starts) { advice = "; --align start lays their first samples on each other"; }
        return Error{ErrorCode::failed, joined.failure + advice};
    }
    return std::move(joined.recording);
}

}  // namespace gyrolog
