#include <memory>

#include <fmt/format.h>

#include "host/app/command.hpp"
#include "host/app/quantity.hpp"
#include "host/capture/recover.hpp"

namespace gyrolog {
namespace {

struct Options {
    std::string damaged;
    std::string recovered;
};

ExitCode recover(Console& console, const Options& options) {
    const auto report = recover_capture(options.damaged, options.recovered);
    if (!report.ok()) { return report_error(console, "recover", report.error()); }
    const BlockAccounts& source = report->source;
    const std::uint64_t left_out = source.bytes_damaged + source.bytes_in_tail;
    console.out << fmt::format("{}: {} of {} kept, {} bytes left out in {} damaged places{}\n",
                               options.recovered, format_bytes(report->bytes_kept),
                               format_bytes(source.bytes_total), format_count(left_out),
                               source.damaged_ranges, source.bytes_in_tail > 0 ? " and a torn tail" : "");
    if (report->header_rewritten) {
        console.err << "gyrolog recover: the header was lost; which board this was is no longer known\n";
    }
    return ExitCode::ok;
}

}  // namespace

Action setup_recover(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("FILE", options->damaged, "The damaged capture")->required();
    app.add_option("-o,--output", options->recovered, "The new file for its intact part")
        ->type_name("FILE")
        ->required();
    return [options](Console& console) { return recover(console, *options); };
}

}  // namespace gyrolog
