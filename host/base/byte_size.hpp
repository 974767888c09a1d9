// Sizes of files and disks as a person reads them.
#pragma once

#include <cstdint>
#include <string>

namespace gyrolog {

// 123456789 as "123 MB": decimal multiples, three digits.
std::string format_bytes(std::uint64_t bytes);

}  // namespace gyrolog
