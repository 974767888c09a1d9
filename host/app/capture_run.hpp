// A capture as the user sees it: announced, watched, summed up.
#pragma once

#include <string>

#include "host/app/capture_options.hpp"
#include "host/app/console.hpp"
#include "host/app/exit_code.hpp"
#include "host/session/open_source.hpp"

namespace gyrolog {

struct CaptureResult {
    ExitCode code = ExitCode::ok;
    bool file_written = false;  // there is a closed, readable capture
    LinkReport link;
};

// Opens the device, captures to `path` until it is enough or the user stops it, and says on `err` what came
// of it. `command` is the name that errors are reported under.
CaptureResult capture_to_file(Console& console, const char* command, const CaptureOptions& options,
                              const std::string& path, bool real_time);

// The same from a source that is open already; denoised, too, where `denoise` is given.
CaptureResult capture_source_to_file(Console& console, const char* command, OpenedSource opened,
                                     CaptureRequest request, bool real_time, LiveDenoise* denoise = nullptr);

// What came of a capture to this path, said on `err`. `limited`: a duration or a number of samples was asked
// for, so that a signal is no end like any other.
CaptureResult tell_outcome(Console& console, const char* command, const Result<CaptureOutcome>& outcome,
                           const std::string& path, bool limited);

}  // namespace gyrolog
