// A RECORDING argument of the command line: a capture, text, or an array of numbers.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/noise/sensor_unit.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/recording/stage_observer.hpp"
#include "host/app/part_choice.hpp"
#include "host/app/text_options.hpp"
#include "host/base/result.hpp"
#include "host/session/load_capture.hpp"

namespace gyrolog {

// Of an array.
struct UnitChoice {
    std::optional<unsigned long> unit{};  // the one that is taken for the gyro (array_reference.hpp)
    bool is_against_others = false;       // the others are its reference
};

struct RecordingInput {
    std::string path;
    std::optional<double> rate_hz;  // overrides the file's own
    std::optional<double> lsb_dps;  // scale of text columns in counts
    StageObserver on_stage{};       // of "read", and for a capture "decode", "place"
    ShareObserver on_share{};       // of a capture: how much of it is read
    // Reading ends soon after so many samples.
    std::size_t samples_most = std::numeric_limits<std::size_t>::max() - 1;
    // More: means of so many, as means_of() has them but for samples that are missing; no more is ever held.
    std::size_t samples_per_row = 1;
    std::optional<double> lsb_g{};   // scale of accelerometer columns in counts
    bool with_accelerometer = true;  // without it, its columns are not read
    bool needs_gyro = true;          // else an accelerometer alone is a recording, too
    // What to do with an accelerometer alone where a gyro is needed.
    std::string_view instead_of_gyro = "`--sensor accelerometer` takes that";
    TextChoice text{};  // what the columns of text are where their names do not say it
    PartChoice part{};
    UnitChoice unit{};  // read_recording() takes it
    // The accelerometer: read_recording() gives it as accelerometer_as_gyro() has it.
    SensorKind sensor = SensorKind::gyro;
    // One that is turned, of a recording that tells its orientation: its rests alone, against the forces
    // there.
    bool in_known_poses = false;
};

// Errors: those of load_capture(), read_recording_file(), take_part(), recording_of_sensor() and
// accelerometer_in_poses(), and
// invalid_argument where counts, scaled by lsb_dps, are rates that no gyro has, and where a gyro is needed
// and there is an accelerometer alone; failed where the array does not have what `unit` asks for.
Result<Recording> read_recording(const RecordingInput& input);

// The same with the times of its part at rest, for a file that is read more than once.
Result<RecordingInput> with_known_part(RecordingInput input);

// With what a capture says beside its samples; of text nothing.
struct TimedRecording {
    Recording recording;
    std::optional<double> host_start_s =
        {};  // of sampling instant 0, by the clock of the host that captured; not known of a part
    std::optional<LoadedCapture> capture = {};
};
Result<TimedRecording> read_timed_recording(const RecordingInput& input);

}  // namespace gyrolog
