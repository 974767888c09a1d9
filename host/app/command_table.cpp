#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/app/command.hpp"
#include "host/app/fleet_input.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/base/counted.hpp"
#include "host/base/file_output.hpp"
#include "host/base/printable.hpp"
#include "host/fleet/fleet_sqlite.hpp"
#include "host/fleet/fleet_table.hpp"
#include "host/fleet/unit_population.hpp"

namespace gyrolog {
namespace {

constexpr std::array table_endings{".csv", ".sqlite"};

struct TableOptions {
    std::vector<std::string> lines;
    std::string output;
    std::string expected;
    std::string population;
    std::string sensor = "gyro";
};

Status check(const TableOptions& options) {
    if (options.output == "-") {
        return invalid_argument(
            "--output '-': give a name that ends in .csv or .sqlite; /dev/stdout takes CSV");
    }
    GYROLOG_CHECK(check_ending({"--output", options.output}, "a table", table_endings));
    std::vector<NamedPath> read{{"--expected", options.expected}};
    for (const std::string& lines : options.lines) { read.push_back({"LINES", lines}); }
    const NamedPath written[] = {{"--output", options.output}, {"--population", options.population}};
    return check_output_paths(read, written);
}

void tell(Console& console, const FleetRecordings& read, const UnitPopulation& population, bool with_notes) {
    for (const OutlyingParameter& one : population.outliers) {
        console.err << fmt::format("gyrolog table: outlier: {}{}{}: {}: robust z {:+.1f}\n",
                                   read.recordings[one.recording].file, one.axis.empty() ? "" : ", axis ",
                                   one.axis, one.name, one.z);
    }
    for (const std::string& name : read.unanswered) {
        console.err << "gyrolog table: no answer: " << printable(name) << '\n';
    }
    if (!with_notes) { return; }
    for (const std::string& note : population.measured.notes) { console.notices() << "  " << note << '\n'; }
}

Status write_population(const FleetRecordings& read, const UnitPopulation& population,
                        const std::string& path) {
    if (population.measured.parameters.empty()) {
        return Error{ErrorCode::failed, fmt::format("write '{}': no spread between units can be told from {}",
                                                    path, counted(read.recordings.size(), "recording"))};
    }
    return write_file(path, as_bytes(format_population(population.measured)));
}

ExitCode write_table(Console& console, const TableOptions& options) {
    const auto fail = [&](const Error& error) { return report_error(console, "table", error); };
    if (const Status fine = check(options); !fine.ok()) { return fail(fine.error()); }
    const Result<FleetRecordings> read = read_fleet(options.lines, options.expected);
    if (!read.ok()) { return fail(read.error()); }
    const UnitPopulation population = population_of(read->recordings);
    const FleetTable table =
        fleet_table(read->recordings, population.outliers, sensors_named(options.sensor));
    ResultOutput results(console);
    results.file(options.output, [&] {
        return options.output.ends_with(".sqlite") ? write_sqlite(table, options.output)
                                                   : write_file(options.output, as_bytes(as_csv(table)));
    });
    results.file(options.population, [&] { return write_population(*read, population, options.population); });
    tell(console, *read, population, !options.population.empty());
    const Status written = results.finish();
    return written.ok() ? ExitCode::ok : fail(written.error());
}

}  // namespace

Action setup_table(CLI::App& app) {
    auto options = std::make_shared<TableOptions>();
    app.add_option(
           "LINES", options->lines,
           "What analyze, check, compare and diagnose wrote with --jsonl; lines about one recording are "
           "joined, and of one command the last counts")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->output,
                   "The table to write, a row for each recording and axis, by its ending: .csv, or .sqlite "
                   "(table `recordings`)")
        ->type_name("FILE")
        ->required();
    app.add_option("--expected", options->expected,
                   "Names of recordings, one a line: those without an answer become rows that say so")
        ->type_name("LIST.txt");
    app.add_option("--population", options->population,
                   "Write how the units differ: a data sheet that `simulate` draws units from")
        ->type_name("FILE.json");
    app.add_option("--sensor", options->sensor, "Whose axes have rows")
        ->check(CLI::IsMember({"gyro", "accelerometer", "all"}))
        ->type_name("NAME")
        ->capture_default_str();
    return [options](Console& console) { return write_table(console, *options); };
}

}  // namespace gyrolog
