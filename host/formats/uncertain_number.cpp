#include "host/formats/uncertain_number.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gyrolog {
namespace {

constexpr int decimals_most = 9;

int decade_of(double x) { return static_cast<int>(std::floor(std::log10(x))); }

// To a multiple of 10^-decimals; never a negative zero.
std::string rounded(double x, int decimals) {
    const double step = std::pow(10.0, -decimals);
    const double multiple = decimals < 0 ? std::round(x / step) * step : x;
    const std::string text = fmt::format("{:.{}f}", multiple, std::max(decimals, 0));
    const bool zero = text.find_first_of("123456789") == std::string::npos;
    return zero && text.front() == '-' ? text.substr(1) : text;
}

// A power of ten before very small and large numbers.
struct Scaled {
    int exponent = 0;

    [[nodiscard]] double unit() const { return std::pow(10.0, exponent); }
    // With which the uncertainty shows two digits.
    [[nodiscard]] int decimals(double uncertainty) const {
        const int digits_after_first = 1 - decade_of(uncertainty / unit());
        const bool rounds_to_the_next_decade =
            std::round(uncertainty / unit() * std::pow(10.0, digits_after_first)) >= 100.0;
        return std::min(digits_after_first - (rounds_to_the_next_decade ? 1 : 0), decimals_most);
    }
};

Scaled scaled(double value, double uncertainty) {
    const double larger = std::max(std::abs(value), uncertainty);
    return {larger < 1e-3 || larger >= 1e6 ? decade_of(larger) : 0};
}

// An uncertainty that decimals_most would show as zero.
bool is_beyond_digits(double value, double uncertainty) {
    return uncertainty / scaled(value, uncertainty).unit() < std::pow(10.0, -decimals_most);
}

}  // namespace

std::string with_uncertainty(double value, double uncertainty) {
    if (!(uncertainty > 0.0)) { return fmt::format("{:.6g}", value); }
    if (is_beyond_digits(value, uncertainty)) { return fmt::format("{:.9g}", value); }
    const Scaled of = scaled(value, uncertainty);
    const int decimals = of.decimals(uncertainty);
    const std::string text =
        rounded(value / of.unit(), decimals) + " ± " + rounded(uncertainty / of.unit(), decimals);
    return of.exponent == 0 ? text : fmt::format("({})e{:+03d}", text, of.exponent);
}

std::string in_short_form(double value, double uncertainty) {
    if (!(uncertainty > 0.0)) { return fmt::format("{:.6g}", value); }
    if (is_beyond_digits(value, uncertainty)) { return fmt::format("{:.9g}", value); }
    Scaled of = scaled(value, uncertainty);
    // No digit may stand in the brackets that the value does not show.
    if (of.decimals(uncertainty) < 0) { of.exponent = decade_of(std::max(std::abs(value), uncertainty)); }
    const int decimals = of.decimals(uncertainty);
    const double last_digits = uncertainty / of.unit() * std::pow(10.0, decimals);
    const std::string text = fmt::format("{}({:.0f})", rounded(value / of.unit(), decimals), last_digits);
    return of.exponent == 0 ? text : fmt::format("{}e{:+03d}", text, of.exponent);
}

std::string in_digits(double value, int digits) {
    constexpr double longest = 1e6;
    const double size = std::abs(value);
    if (size < 1.0 || size >= longest) { return fmt::format("{:.{}g}", value, digits); }
    const int decimals = digits - 1 - decade_of(size);
    return decimals >= 0 ? fmt::format("{:.{}g}", value, digits) : rounded(value, decimals);
}

std::string duration_text(double seconds) {
    // What rounds to a second is one.
    if (seconds < 0.9995) { return fmt::format("{:.3g} ms", seconds * 1e3); }
    if (seconds < 120.0) { return fmt::format("{:.3g} s", seconds); }
    if (seconds < 7200.0) { return fmt::format("{:.3g} min", seconds / 60.0); }
    return fmt::format("{:.3g} h", seconds / 3600.0);
}

}  // namespace gyrolog
