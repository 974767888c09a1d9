#include "host/app/fleet_input.hpp"

#include <iterator>
#include <vector>

#include "host/app/exit_code.hpp"

namespace gyrolog {
namespace {

int worst_code(int a, int b) {
    return static_cast<int>(worst_of(static_cast<ExitCode>(a), static_cast<ExitCode>(b)));
}

}  // namespace

Result<FleetRecordings> read_fleet(std::span<const std::string> lines_paths,
                                   const std::string& expected_path) {
    std::vector<FleetLine> lines;
    for (const std::string& path : lines_paths) {
        GYROLOG_TRY(std::vector<FleetLine> more, read_fleet_lines(path));
        lines.insert(lines.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    }
    std::vector<std::string> expected;
    if (!expected_path.empty()) { GYROLOG_TRY(expected, read_name_list(expected_path)); }
    return join_lines(lines, expected, worst_code);
}

}  // namespace gyrolog
