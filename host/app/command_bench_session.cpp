// The program without a command: find the board, capture with a live view, on Ctrl-C close the file and
// analyse it; on another program's signal close it only.

#include <csignal>
#include <ctime>
#include <filesystem>
#include <memory>
#include <span>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "host/app/analysis_run.hpp"
#include "host/app/capture_run.hpp"
#include "host/app/command.hpp"
#include "host/app/device_choice.hpp"
#include "host/app/output_paths.hpp"

namespace gyrolog {
namespace {

struct BenchSessionOptions {
    CaptureOptions capture;
    std::string path;
};

// "gyrolog-20261121-143005", in the folder where the user stands.
std::string name_by_time() {
    std::tm now{};
    const std::time_t seconds = std::time(nullptr);
    localtime_r(&seconds, &now);
    return fmt::format("gyrolog-{:%Y%m%d-%H%M%S}", now);
}

std::string without_extension(const std::string& path) {
    const std::string ending = ".pcapng";
    return path.ends_with(ending) ? path.substr(0, path.size() - ending.size()) : path;
}

// Names that the program chooses: what stands there is somebody's, and was not given up by naming it.
Status refuse_existing(std::span<const NamedPath> results) {
    for (const NamedPath& result : results) {
        std::error_code unknown;
        if (std::filesystem::is_regular_file(result.path, unknown)) {
            return invalid_argument(
                fmt::format("write {} '{}': it exists; choose another name for the capture, or --force",
                            result.option, result.path));
        }
    }
    return {};
}

ExitCode bench_session(Console& console, BenchSessionOptions options) {
    if (options.capture.devices.size() > 1) {
        return report_error(
            console, "",
            {ErrorCode::invalid_argument,
             "several boards at once: run `gyrolog capture`, then `gyrolog analyze` for each file"});
    }
    if (options.path.empty()) { options.path = name_by_time() + ".pcapng"; }
    AnalysisRequest request;
    request.recording_path = options.path;
    request.json_path = without_extension(options.path) + ".json";
    request.plot_path = without_extension(options.path) + ".png";
    request.model_path = without_extension(options.path) + ".model.json";
    const std::string second_plot = second_figure(request.plot_path);
    const std::string device =
        options.capture.devices.empty() ? std::string() : file_of_device(options.capture.devices.front());
    const NamedPath read[] = {{"--device", device}};
    const NamedPath written[] = {{"--output", options.path},
                                 {"the report", request.json_path},
                                 {"the figure", request.plot_path},
                                 {"the accelerometer's figure", second_plot},
                                 {"the noise model", request.model_path}};
    if (const Status fine = check_output_paths(read, written); !fine.ok()) {
        return report_error(console, "", fine.error());
    }
    if (const Status fine = check_ending(written[0], "a capture", capture_endings); !fine.ok()) {
        return report_error(console, "", fine.error());
    }
    if (const Status fine = refuse_existing(std::span(written).subspan(1));
        !options.capture.force && !fine.ok()) {
        return report_error(console, "", fine.error());
    }
    const CaptureResult captured = capture_to_file(console, "", options.capture, options.path, true);
    if (!captured.file_written) {
        if (captured.code == ExitCode::no_device) {
            console.err << "without a board: `gyrolog --device sim:` runs a virtual one\n";
        }
        return captured.code;
    }
    if (captured.link.samples.good == 0) {
        console.err << "there is nothing to analyse\n";
        return captured.code == ExitCode::ok ? ExitCode::failed : captured.code;
    }
    if (const int signal = console.stop_wanted() ? console.signal->load() : 0;
        signal != 0 && signal != SIGINT) {
        // Whoever sends these does not wait for an analysis.
        console.err << "not analysed: ended by a signal (" << signal << "); run `gyrolog analyze "
                    << options.path << "`\n";
        return captured.code == ExitCode::ok ? ended_by_signal(signal) : captured.code;
    }
    const ExitCode analysed = analyze_to_files(console, "analyze", request);
    // The capture's own verdict comes first: a lost device stays a lost device however well its data analyse.
    return captured.code == ExitCode::ok ? analysed : captured.code;
}

}  // namespace

Action setup_bench_session(CLI::App& app) {
    auto options = std::make_shared<BenchSessionOptions>();
    app.add_option("-o,--output", options->path, "The capture to write (default: gyrolog-DATE-TIME.pcapng)")
        ->type_name("FILE");
    options->capture.declare(app);
    return [options](Console& console) { return bench_session(console, *options); };
}

}  // namespace gyrolog
