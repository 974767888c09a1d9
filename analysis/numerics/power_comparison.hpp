// Powers of whole numbers, compared exactly where a double's logarithm cannot tell.
#pragma once

#include <cstdint>

namespace gyrolog {

// Whether base^exponent >= 2^bits. 0^0 is 1.
bool power_reaches(std::uint64_t base, unsigned exponent, unsigned bits);

}  // namespace gyrolog
