// Any bytes as the list of names of `table --expected`: each becomes a row of its own, and none gets a
// control character or another line into the table.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "host/fleet/fleet_line.hpp"
#include "host/fleet/fleet_recording.hpp"
#include "host/fleet/fleet_table.hpp"
#include "host/fleet/unit_population.hpp"
#include "tests/fuzz/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace gyrolog;
    const MemoryFile file({data, size});
    const auto names = read_name_list(file.path());
    if (!names.ok()) {
        GYROLOG_REQUIRE(!names.error().message.empty());
        return 0;
    }
    for (const std::string& name : *names) { GYROLOG_REQUIRE(!name.empty()); }
    const auto joined =
        join_lines(std::vector<FleetLine>(), *names, [](int a, int b) { return std::max(a, b); });
    GYROLOG_REQUIRE(joined.recordings.size() == joined.unanswered.size());
    GYROLOG_REQUIRE(joined.recordings.size() <= names->size());
    const auto population = population_of(joined.recordings);
    const std::string text = as_csv(fleet_table(joined.recordings, population.outliers, Sensors::all));
    std::size_t lines = 0;
    for (const char c : text) {
        const auto byte = static_cast<std::uint8_t>(c);
        GYROLOG_REQUIRE(byte == '\n' || (byte >= 0x20 && byte != 0x7F));
        lines += byte == '\n' ? 1U : 0U;
    }
    GYROLOG_REQUIRE(lines == 1 + joined.recordings.size());
    return 0;
}
