#include <memory>

#include "host/app/capture_report.hpp"
#include "host/app/command.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

struct CheckOptions {
    std::string path;
    std::string json;
};

std::shared_ptr<CheckOptions> declare(CLI::App& app) {
    auto options = std::make_shared<CheckOptions>();
    app.add_option("FILE", options->path, "A capture (.pcapng)")->required();
    app.add_option("--json", options->json, "Write the answer as JSON to FILE (- for standard output)")
        ->type_name("FILE");
    return options;
}

ExitCode tell(Console& console, const char* command, const CheckOptions& options,
              Json (*as_json)(const std::string&, const LoadedCapture&),
              std::string (*as_text)(const std::string&, const LoadedCapture&), ExitCode when_missing) {
    const NamedPath read[] = {{"FILE", options.path}};
    const NamedPath paths[] = {{"--json", options.json}};
    if (const Status fine = check_output_paths(read, paths); !fine.ok()) {
        return report_error(console, command, fine.error());
    }
    const auto capture = load_capture(options.path, false);
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
    const auto options = declare(app);
    return [options](Console& console) {
        return tell(console, "check", *options, check_json, check_text, ExitCode::data_lost);
    };
}

Action setup_info(CLI::App& app) {
    const auto options = declare(app);
    return [options](Console& console) {
        return tell(console, "info", *options, info_json, info_text, ExitCode::ok);
    };
}

}  // namespace gyrolog
