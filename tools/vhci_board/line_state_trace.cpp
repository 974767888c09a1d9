#include "tools/vhci_board/line_state_trace.hpp"

#include <charconv>
#include <optional>

namespace gyrolog {
namespace {

std::optional<unsigned> value_of(std::string_view line) {
    constexpr std::string_view key = " value=";
    const std::size_t at = line.rfind(key);
    if (at == std::string_view::npos) { return std::nullopt; }
    const std::string_view digits = line.substr(at + key.size());
    unsigned value = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (problem != std::errc{} || end != digits.data() + digits.size()) { return std::nullopt; }
    return value;
}

}  // namespace

std::vector<unsigned> LineStateTrace::append(std::string_view text) {
    std::vector<unsigned> values;
    line_ += text;
    std::size_t end = 0;
    while ((end = line_.find('\n')) != std::string::npos) {
        if (const auto value = value_of(std::string_view(line_).substr(0, end))) { values.push_back(*value); }
        line_.erase(0, end + 1);
    }
    return values;
}

}  // namespace gyrolog
