#include "host/report/base64.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace gyrolog {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::size_t group_bytes = 3;
constexpr std::size_t group_digits = 4;
constexpr unsigned bits_of_digit = 6;

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
    std::string text;
    text.reserve((bytes.size() + group_bytes - 1) / group_bytes * group_digits);
    for (std::size_t at = 0; at < bytes.size(); at += group_bytes) {
        const std::size_t here = std::min(group_bytes, bytes.size() - at);
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < group_bytes; ++i) {
            bits = bits << 8U | (i < here ? bytes[at + i] : std::uint8_t{0});
        }
        for (std::size_t i = 0; i < group_digits; ++i) {
            const auto shift = static_cast<unsigned>(group_digits - 1 - i) * bits_of_digit;
            text += i <= here ? digits[bits >> shift & 0x3FU] : '=';
        }
    }
    return text;
}

}  // namespace gyrolog
