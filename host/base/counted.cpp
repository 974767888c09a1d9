#include "host/base/counted.hpp"

#include <cstddef>

namespace gyrolog {

std::string format_count(std::uint64_t count) {
    std::string digits = std::to_string(count);
    for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3) {
        digits.insert(static_cast<std::size_t>(at), 1, ',');
    }
    return digits;
}

std::string counted(std::uint64_t count, std::string_view noun) {
    return format_count(count).append(" ").append(noun).append(count == 1 ? "" : "s");
}

}  // namespace gyrolog
