// Any text cut into KEY=VALUE pairs at its commas: parsing ends in options within their ranges, or in an
// error.

#include <cstdint>
#include <string_view>

#include "host/virtual_board/sim_options.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    std::vector<std::pair<std::string, std::string>> pairs;
    while (!rest.empty()) {
        const std::string_view option = rest.substr(0, rest.find(','));
        rest.remove_prefix(option.size() < rest.size() ? option.size() + 1 : rest.size());
        const std::string_view key = option.substr(0, option.find('='));
        pairs.emplace_back(key, option.substr(key.size() < option.size() ? key.size() + 1 : key.size()));
    }
    const auto options = gyrolog::parse_sim_options(pairs);
    if (!options.ok()) {
        GYROLOG_REQUIRE(!options.error().message.empty());
        return 0;
    }
    GYROLOG_REQUIRE(options->board >= 1 && options->board <= options->boards);
    for (const gyrolog::BoardFault& fault : options->faults) {
        GYROLOG_REQUIRE(fault.at_s >= 0.0 && fault.duration_s >= 0.0);
    }
    return 0;
}
