#include "host/app/quantity.hpp"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace gyrolog {

Result<double> parse_duration_s(std::string_view text) {
    double value = 0.0;
    const auto [rest, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string_view unit(rest, static_cast<std::size_t>(text.data() + text.size() - rest));
    double factor = 0.0;
    if (unit.empty() || unit == "s") { factor = 1.0; }
    if (unit == "m" || unit == "min") { factor = 60.0; }
    if (unit == "h") { factor = 3600.0; }
    if (unit == "d") { factor = 86400.0; }
    const double duration_s = value * factor;
    constexpr double ten_years_s = 10.0 * 365.25 * 86400.0;
    if (problem != std::errc() || factor == 0.0 || std::isnan(duration_s)) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("'{}' is no duration: write 90, 90s, 15m, 6h or 1d", text)};
    }
    if (duration_s <= 0.0 || duration_s > ten_years_s) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("'{}' is no duration: it has to be {}", text,
                                 duration_s <= 0.0 ? "longer than 0" : "ten years at the most")};
    }
    return duration_s;
}

Result<std::uint64_t> parse_bytes(std::string_view text) {
    double value = 0.0;
    const auto [rest, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    std::string_view unit(rest, static_cast<std::size_t>(text.data() + text.size() - rest));
    if (unit.ends_with('B')) { unit.remove_suffix(1); }
    const bool binary = unit.ends_with('i');
    if (binary) { unit.remove_suffix(1); }
    constexpr std::string_view prefixes = "kMGT";
    const std::size_t at = unit.size() == 1 ? prefixes.find(unit == "K" ? 'k' : unit.front()) : prefixes.npos;
    const bool known = unit.empty() ? !binary : at != std::string_view::npos;
    const double factor =
        unit.empty() ? 1.0 : std::pow(binary ? 1024.0 : 1000.0, static_cast<double>(at + 1));
    const double bytes = std::round(value * factor);
    if (problem != std::errc() || !known || !(bytes >= 1.0 && bytes <= 1e18)) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("'{}' is no size: write 64k, 500M, 2G, 1T or 1GiB", text)};
    }
    return static_cast<std::uint64_t>(bytes);
}

Result<std::vector<std::int64_t>> parse_whole_numbers(std::string_view text) {
    std::vector<std::int64_t> numbers;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    while (true) {
        std::int64_t number = 0;
        const auto [rest, problem] = std::from_chars(at, end, number);
        if (problem != std::errc() || number < 1 || (rest != end && *rest != ',')) {
            return Error{ErrorCode::invalid_argument,
                         fmt::format("'{}' is no list of whole numbers from 1 up: write 1,10,100", text)};
        }
        numbers.push_back(number);
        if (rest == end) { return numbers; }
        at = rest + 1;
    }
}

std::string format_elapsed(double duration_s) {
    const auto seconds = static_cast<std::int64_t>(duration_s);
    return fmt::format("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

std::string format_duration(double duration_s) {
    if (duration_s >= 2.0 * 86400.0) { return fmt::format("{:.3g} d", duration_s / 86400.0); }
    if (duration_s >= 2.0 * 3600.0) { return fmt::format("{:.3g} h", duration_s / 3600.0); }
    if (duration_s >= 2.0 * 60.0) { return fmt::format("{:.3g} min", duration_s / 60.0); }
    return fmt::format("{:.3g} s", duration_s);
}

}  // namespace gyrolog
