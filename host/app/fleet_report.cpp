#include "host/app/fleet_report.hpp"

#include <algorithm>
#include <filesystem>

#include "host/app/command.hpp"
#include "host/app/fleet_input.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/report_figures.hpp"
#include "host/app/result_output.hpp"
#include "host/base/counted.hpp"
#include "host/report/fleet_page.hpp"

namespace gyrolog {
namespace {

Status check_paths(const FleetReportRequest& request) {
    std::vector<NamedPath> read{{"--expected", request.expected_path}};
    for (const std::string& lines : request.lines_paths) { read.push_back({"LINES", lines}); }
    const NamedPath written[] = {{"--output", request.page_path}};
    if (Status fine = check_output_paths(read, written); !fine.ok()) { return fine; }
    return check_ending(written[0], "a page", page_endings);
}

std::string name_of(const FleetReportRequest& request) {
    if (request.lines_paths.size() > 1) {
        return counted(request.lines_paths.size(), "file") + " of results";
    }
    return std::filesystem::path(request.lines_paths.front()).filename().string();
}

}  // namespace

bool is_named_like_lines(const std::string& path) {
    constexpr std::array endings{".jsonl", ".jsonl.gz", ".jsonl.xz", ".jsonl.zst", ".jsonl.bz2"};
    return std::ranges::any_of(endings, [&](const char* ending) { return path.ends_with(ending); });
}

ExitCode fleet_report_to_file(Console& console, const FleetReportRequest& request) {
    const auto fail = [&](const Error& error) { return report_error(console, "report", error); };
    if (const Status fine = check_paths(request); !fine.ok()) { return fail(fine.error()); }
    const Result<FleetRecordings> read = read_fleet(request.lines_paths, request.expected_path);
    if (!read.ok()) { return fail(read.error()); }
    const UnitPopulation population = population_of(read->recordings);
    const Result<Png> spread = draw_spread(population);
    if (!spread.ok()) { return fail(spread.error()); }
    ResultOutput results(console);
    results.text(request.page_path, [&] {
        return fleet_html({name_of(request), *read, population, *spread});
    });
    const Status written = results.finish();
    return written.ok() ? ExitCode::ok : fail(written.error());
}

}  // namespace gyrolog
