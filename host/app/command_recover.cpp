#include <memory>

#include <fmt/format.h>

#include "host/app/command.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/base/byte_size.hpp"
#include "host/base/counted.hpp"
#include "host/capture/recover.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {
namespace {

struct RecoverOptions {
    std::string damaged;
    std::string recovered;
    std::string json;
};

Json recovery_json(const RecoverOptions& options, const RecoveryReport& report) {
    const BlockAccounts& source = report.source;
    return {{"schema", "gyrolog-recover/1"},
            {"file", options.damaged},
            {"recovered", options.recovered},
            {"bytes",
             {{"total", source.bytes_total},
              {"kept", report.bytes_kept},
              {"damaged", source.bytes_damaged},
              {"in_tail", source.bytes_in_tail}}},
            {"damaged_places", source.damaged_ranges},
            {"header_rewritten", report.header_rewritten}};
}

std::string recovery_text(const RecoverOptions& options, const RecoveryReport& report) {
    const BlockAccounts& source = report.source;
    const std::uint64_t left_out = source.bytes_damaged + source.bytes_in_tail;
    return fmt::format("{}: {} of {} kept, {} left out in {}{}\n", options.recovered,
                       format_bytes(report.bytes_kept), format_bytes(source.bytes_total),
                       counted(left_out, "byte"), counted(source.damaged_ranges, "damaged place"),
                       source.bytes_in_tail > source.bytes_behind_close ? " and a torn tail" : "");
}

ExitCode recover(Console& console, const RecoverOptions& options) {
    const NamedPath read[] = {{"FILE", options.damaged}};
    const NamedPath paths[] = {{"--output", options.recovered}, {"--json", options.json}};
    if (const Status fine = check_output_paths(read, paths); !fine.ok()) {
        return report_error(console, "recover", fine.error());
    }
    if (const Status named = check_ending(paths[0], "a capture", capture_endings); !named.ok()) {
        return report_error(console, "recover", named.error());
    }
    const auto report = recover_capture(options.damaged, options.recovered);
    if (!report.ok()) { return report_error(console, "recover", report.error()); }
    if (report->header_rewritten) {
        console.err << "gyrolog recover: the header was lost; which board this was is no longer known\n";
    }
    ResultOutput results(console);
    if (options.json != "-") { results.show(recovery_text(options, *report)); }
    results.json(options.json, [&] { return recovery_json(options, *report); });
    const Status written = results.finish();
    return written.ok() ? ExitCode::ok : report_error(console, "recover", written.error());
}

}  // namespace

Action setup_recover(CLI::App& app) {
    auto options = std::make_shared<RecoverOptions>();
    app.add_option("FILE", options->damaged, "The damaged capture")->required();
    app.add_option("-o,--output", options->recovered, "The new file for its intact part")
        ->type_name("FILE")
        ->required();
    app.add_option("--json", options->json, "Write the answer as JSON to FILE (- for standard output)")
        ->type_name("FILE");
    return [options](Console& console) { return recover(console, *options); };
}

}  // namespace gyrolog
