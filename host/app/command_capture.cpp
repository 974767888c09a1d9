#include <memory>

#include <fmt/format.h>

#include "host/app/boards_capture.hpp"
#include "host/app/capture_report.hpp"
#include "host/app/capture_run.hpp"
#include "host/app/command.hpp"
#include "host/app/device_choice.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/capture/segment_files.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

struct CaptureCommandOptions {
    CaptureOptions capture;
    std::string path;
    std::string json;
};

// Nothing that the board is made of or that denoising knows is written over.
Status check_paths(const CaptureCommandOptions& options) {
    const std::vector<std::string>& devices = options.capture.devices;
    std::vector<std::string> files;
    files.reserve(devices.size());
    for (const std::string& uri : devices) { files.push_back(file_of_device(uri)); }
    std::vector<NamedPath> read{{"--denoise-model", options.capture.denoise.model}};
    read.reserve(files.size() + 1);
    for (const std::string& file : files) { read.push_back({"--device", file}); }
    const std::string denoised =
        options.capture.denoise.wanted() ? options.capture.denoise.output_of(options.path) : "";
    const NamedPath written[] = {
        {"--output", options.path}, {"--denoise-out", denoised}, {"--json", options.json}};
    GYROLOG_CHECK(check_output_paths(read, written));
    for (const NamedPath& result : {written[1], written[2]}) {
        if (result.path.empty() || result.path == "-" || !is_segment_path(result.path, options.path)) {
            continue;
        }
        return invalid_argument(
            fmt::format("{} '{}': further files of the capture get such names, {}; give another",
                        result.option, result.path, segment_path(options.path, 2)));
    }
    return check_ending(written[0], "a capture", capture_endings);
}

Status check_denoise(const CaptureCommandOptions& options, std::size_t boards) {
    const LiveDenoiseOptions& denoise = options.capture.denoise;
    GYROLOG_CHECK(denoise.check(options.capture.rate_hz));
    if (!denoise.wanted()) { return {}; }
    if (boards > 1) {
        return Error{ErrorCode::invalid_argument,
                     "--denoise is of one board: capture several without it, and denoise their array "
                     "afterwards, `gyrolog denoise A.pcapng B.pcapng C.pcapng -o FUSED.csv`"};
    }
    return {};
}

ExitCode capture(Console& console, const CaptureCommandOptions& options) {
    if (const Status fine = check_paths(options); !fine.ok()) {
        return report_error(console, "capture", fine.error());
    }
    const auto devices = choose_devices(options.capture.devices);
    if (!devices.ok()) {
        report_error(console, "capture", devices.error());
        return exit_code_of_opening(devices.error());
    }
    if (const Status fine = check_denoise(options, devices->size()); !fine.ok()) {
        return report_error(console, "capture", fine.error());
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
    ResultOutput results(console);
    results.json(options.json, [&] { return check_json(options.path, *stored); });
    const Status written = results.finish();
    return written.ok() ? result.code : report_error(console, "capture", written.error());
}

}  // namespace

Action setup_capture(CLI::App& app) {
    auto options = std::make_shared<CaptureCommandOptions>();
    app.add_option("-o,--output", options->path, "The capture to write (.pcapng)")
        ->type_name("FILE")
        ->required();
    options->capture.declare(app);
    options->capture.denoise.declare(app);
    app.add_option("--json", options->json,
                   "Afterwards, write what `check` says as JSON (- for standard output)")
        ->type_name("FILE");
    return [options](Console& console) { return capture(console, *options); };
}

}  // namespace gyrolog
