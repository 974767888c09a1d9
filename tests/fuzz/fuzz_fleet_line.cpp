// Any text at all: a line of results ends in numbers that can be a row of a table, or in an error that says
// what is wrong.

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "host/fleet/fleet_recording.hpp"
#include "host/fleet/fleet_table.hpp"
#include "host/fleet/unit_population.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto line = gyrolog::parse_fleet_line(text);
    if (!line.ok()) {
        GYROLOG_REQUIRE(!line.error().message.empty());
        return 0;
    }
    GYROLOG_REQUIRE(!line->file.empty());
    const std::vector<gyrolog::FleetLine> lines(2, *line);
    const auto joined = gyrolog::join_lines(lines, {}, [](int a, int b) { return std::max(a, b); });
    GYROLOG_REQUIRE(joined.recordings.size() == 1);
    const auto population = gyrolog::population_of(joined.recordings);
    const auto table = gyrolog::fleet_table(joined.recordings, population.outliers, gyrolog::Sensors::all);
    GYROLOG_REQUIRE(!table.rows.empty());
    for (const auto& row : table.rows) { GYROLOG_REQUIRE(row.size() == table.columns.size()); }
    GYROLOG_REQUIRE(!gyrolog::as_csv(table).empty());
    return 0;
}
