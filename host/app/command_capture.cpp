#include <memory>

#include <nlohmann/json.hpp>

#include "host/app/boards_capture.hpp"
#include "host/app/capture_report.hpp"
#include "host/app/capture_run.hpp"
#include "host/app/command.hpp"
#include "host/app/device_choice.hpp"
#include "host/app/result_output.hpp"

namespace gyrolog {
namespace {

struct Options {
    CaptureOptions capture;
    std::string path;
    std::string json;
};

ExitCode capture(Console& console, const Options& options) {
    const auto devices = choose_devices(options.capture.devices);
    if (!devices.ok()) {
        report_error(console, "capture", devices.error());
        return exit_code_of_opening(devices.error());
    }
    if (devices->size() > 1) {
        if (!options.json.empty()) {
            return report_error(console, "capture",
                                {ErrorCode::invalid_argument,
                                 "--json tells of one file: run `gyrolog check FILE --json` for each board"});
        }
        return capture_boards(console, "capture", options.capture, *devices, options.path);
    }
    CaptureOptions one = options.capture;
    one.devices = *devices;
    const CaptureResult result = capture_to_file(console, "capture", one, options.path, false);
    if (!result.file_written || options.json.empty()) { return result.code; }
    const auto stored = load_capture(options.path, false);
    if (!stored.ok()) { return report_error(console, "capture", stored.error()); }
    const Status written = write_json(console, options.json, check_json(options.path, *stored));
    return written.ok() ? result.code : report_error(console, "capture", written.error());
}

}  // namespace

Action setup_capture(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("-o,--output", options->path, "The capture to write (.pcapng)")
        ->type_name("FILE")
        ->required();
    options->capture.declare(app);
    app.add_option("--json", options->json,
                   "Afterwards, write what `check` says as JSON (- for standard output)")
        ->type_name("FILE");
    return [options](Console& console) { return capture(console, *options); };
}

}  // namespace gyrolog
