// Quantities as the user types them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/result.hpp"

namespace gyrolog {

// "90", "90s", "15m", "6h", "1d", also with a fraction: seconds, more than 0.
Result<double> parse_duration_s(std::string_view text);

// "500M", "2G", "1.5T", "64k", "1GB" (decimal multiples), "1GiB", "4096": bytes, more than 0.
Result<std::uint64_t> parse_bytes(std::string_view text);

// "1,10,100": positive whole numbers.
Result<std::vector<std::int64_t>> parse_whole_numbers(std::string_view text);

// 3723.4 as "1:02:03".
std::string format_elapsed(double duration_s);

// 43200 as "12 h", 655.1 as "10.9 min": one unit, three digits.
std::string format_duration(double duration_s);

}  // namespace gyrolog
