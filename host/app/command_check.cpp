#include <memory>
#include <optional>
#include <utility>

#include "host/app/capture_report.hpp"
#include "host/app/command.hpp"
#include "host/app/many_recordings.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/progress_line.hpp"
#include "host/app/result_output.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

struct CheckOptions {
    std::string path;
    std::string json;
};

constexpr const char* what_is_read = "A capture (.pcapng)";

void declare_json(CLI::App& app, CheckOptions& options) {
    app.add_option("--json", options.json, "Write the answer as JSON to FILE (- for standard output)")
        ->type_name("FILE");
}

ExitCode tell(Console& console, const char* command, const CheckOptions& options,
              Json (*as_json)(const std::string&, const LoadedCapture&),
              std::string (*as_text)(const std::string&, const LoadedCapture&), ExitCode when_missing) {
    const NamedPath read[] = {{"FILE", options.path}};
    const NamedPath paths[] = {{"--json", options.json}};
    if (const Status fine = check_output_paths(read, paths); !fine.ok()) {
        return report_error(console, command, fine.error());
    }
    std::optional<ProgressLine> progress(std::in_place, console);
    const auto capture = load_capture(options.path, false, {}, {}, progress->of_reading());
    progress.reset();
    if (!capture.ok()) { return report_error(console, command, capture.error()); }
    ResultOutput results(console);
    if (options.json != "-") { results.show(as_text(options.path, *capture)); }
    results.json(options.json, [&] { return as_json(options.path, *capture); });
    if (const Status written = results.finish(); !written.ok()) {
        return report_error(console, command, written.error());
    }
    return nothing_missing(*capture) ? ExitCode::ok : when_missing;
}

}  // namespace

Action setup_check(CLI::App& app) {
    const auto options = std::make_shared<CheckOptions>();
    const auto many = std::make_shared<ManyRecordings>();
    declare_json(app, *options);
    add_recordings(app, *many, "FILE", what_is_read)->required();
    return [options, many](Console& console) {
        const auto run = [&](Console& own, const std::string& recording, bool as_line) {
            const CheckOptions one{recording, as_line ? "-" : options->json};
            return tell(own, "check", one, check_json, check_text, ExitCode::data_lost);
        };
        return run_on_recordings(console, "check", *many, {}, run);
    };
}

Action setup_info(CLI::App& app) {
    const auto options = std::make_shared<CheckOptions>();
    app.add_option("FILE", options->path, what_is_read)->required();
    declare_json(app, *options);
    return [options](Console& console) {
        return tell(console, "info", *options, info_json, info_text, ExitCode::ok);
    };
}

}  // namespace gyrolog
