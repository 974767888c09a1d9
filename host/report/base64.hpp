// Bytes as text (RFC 4648, section 4), for a picture inside a page.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace gyrolog {

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace gyrolog
