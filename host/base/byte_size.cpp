#include "host/base/byte_size.hpp"

#include <array>
#include <charconv>
#include <cstddef>

namespace gyrolog {

std::string format_bytes(std::uint64_t bytes) {
    constexpr std::array units{"B", "kB", "MB", "GB", "TB"};
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (value >= 999.5 && unit + 1 < units.size()) {
        value /= 1000.0;
        ++unit;
    }
    std::array<char, 32> digits{};
    const auto written =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 3);
    return std::string(digits.data(), written.ptr) + " " + units.at(unit);
}

}  // namespace gyrolog
