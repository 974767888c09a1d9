#include <memory>

#include "host/app/command.hpp"
#include "host/app/device_choice.hpp"
#include "host/app/former_id.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/app/stop_signal.hpp"
#include "host/base/printable.hpp"
#include "host/conform/conformance.hpp"
#include "host/conform/conversation.hpp"
#include "host/formats/conform_report.hpp"
#include "host/formats/json.hpp"
#include "host/session/open_source.hpp"

namespace gyrolog {
namespace {

struct ConformOptions {
    std::string device = "usb:";
    std::string json;
    std::string transcript;
};

ExitCode fail_to_open(Console& console, const Error& error) {
    report_error(console, "conform", error);
    return exit_code_of_opening(error);
}

ExitCode conform(Console& console, const ConformOptions& options) {
    const std::string made_of = file_of_device(options.device);
    const NamedPath read[] = {{"--device", made_of}};
    const NamedPath paths[] = {{"--json", options.json}, {"--transcript", options.transcript}};
    if (const Status fine = check_output_paths(read, paths); !fine.ok()) {
        return report_error(console, "conform", fine.error());
    }
    auto opened = open_source(options.device, {}, false);
    if (!opened.ok()) { return fail_to_open(console, opened.error()); }
    console.notices() << "gyrolog conform: talking to " << printable(opened->source->identity().uri)
                      << " for about ten seconds\n";
    warn_of_former_id(console, "conform", opened->source->identity());
    const auto dialogue = [&] {
        const TidyEnd tidy;  // the board is left as it was found
        return converse(*opened->source, [&] { return !console.stop_wanted(); });
    }();
    if (!dialogue.ok()) {
        if (dialogue.error().code == ErrorCode::unsupported) {
            report_error(
                console, "conform",
                {ErrorCode::invalid_argument,
                 dialogue.error().message + "; conform wants a device that answers: usb:, tty:PATH or sim:"});
            return ExitCode::usage;
        }
        const ExitCode code = fail_to_open(console, dialogue.error());
        const bool ended = dialogue.error().code == ErrorCode::failed && console.stop_wanted();
        return ended ? ended_by_signal(console.signal->load()) : code;
    }
    const ConformanceReport report = judge(*dialogue);
    ResultOutput results(console);
    if (options.json != "-") { results.show(conform_text(report)); }
    results.text(options.transcript, [&] { return transcript_text(*dialogue); });
    results.json(options.json, [&] { return conform_json(report); });
    if (const Status written = results.finish(); !written.ok()) {
        return report_error(console, "conform", written.error());
    }
    return report.conforms() ? ExitCode::ok : ExitCode::not_conforming;
}

}  // namespace

Action setup_conform(CLI::App& app) {
    auto options = std::make_shared<ConformOptions>();
    app.add_option("--device", options->device,
                   "usb: (the only board), usb:SERIAL, tty:PATH[,speed=BAUD] or sim:KEY=VALUE,...")
        ->type_name("URI")
        ->capture_default_str();
    app.add_option("--json", options->json, "Write the verdicts as JSON to FILE (- for standard output)")
        ->type_name("FILE");
    app.add_option("--transcript", options->transcript, "Write the whole conversation with its bytes to FILE")
        ->type_name("FILE");
    return [options](Console& console) { return conform(console, *options); };
}

}  // namespace gyrolog
