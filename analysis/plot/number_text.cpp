#include "analysis/plot/number_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string_view>

namespace gyrolog {
namespace {

constexpr std::array<std::string_view, 10> raised_digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

// The exponent of the number's first digit after rounding to that many digits: 9.996 at three digits has 1.
int decimal_exponent(double magnitude, int significant_digits) {
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), magnitude,
                                   std::chars_format::scientific, significant_digits - 1);
    const std::string_view written(text.data(), static_cast<std::size_t>(end.ptr - text.data()));
    std::string_view exponent = written.substr(written.find('e') + 1);
    if (exponent.front() == '+') { exponent.remove_prefix(1); }
    int value = 0;
    std::from_chars(exponent.data(), exponent.data() + exponent.size(), value);
    return value;
}

bool reads_better_with_power(int exponent) { return exponent < -3 || exponent > 3; }

// value / 10^exponent, also where 10^exponent itself is no double.
double scaled_down(double value, int exponent) {
    const int half = exponent / 2;
    return value / std::pow(10.0, half) / std::pow(10.0, exponent - half);
}

}  // namespace

std::string power_of_ten(int exponent) {
    std::string text = exponent < 0 ? "10⁻" : "10";
    for (const char digit : std::to_string(std::abs(exponent))) {
        text += raised_digits[static_cast<std::size_t>(digit - '0')];
    }
    return text;
}

std::string fixed_decimal(double value, int decimals) {
    if (!std::isfinite(value)) { return std::isnan(value) ? "–" : (value > 0.0 ? "∞" : "−∞"); }
    std::array<char, 400> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), std::fabs(value),
                                   std::chars_format::fixed, std::clamp(decimals, 0, 60));
    const std::string_view digits(text.data(), static_cast<std::size_t>(end.ptr - text.data()));
    const bool is_zero = digits.find_first_not_of("0.") == std::string_view::npos;
    return std::string(value < 0.0 && !is_zero ? "−" : "").append(digits);
}

std::string rounded_number(double value, int significant_digits) {
    if (!std::isfinite(value)) { return fixed_decimal(value, 0); }
    if (value == 0.0) { return "0"; }
    const int exponent = decimal_exponent(std::fabs(value), significant_digits);
    if (reads_better_with_power(exponent)) {
        return fixed_decimal(scaled_down(value, exponent), significant_digits - 1) + "×" +
               power_of_ten(exponent);
    }
    return fixed_decimal(value, significant_digits - 1 - exponent);
}

std::string short_number(double value, int significant_digits) {
    std::string text = rounded_number(value, significant_digits);
    const std::size_t end = std::min(text.find("×"), text.size());
    const std::string number = text.substr(0, end);
    if (number.find('.') == std::string::npos) { return text; }
    const std::size_t last = number.find_last_not_of('0');
    return number.substr(0, number[last] == '.' ? last : last + 1) + text.substr(end);
}

std::string number_with_uncertainty(double value, std::optional<double> uncertainty) {
    const bool usable = uncertainty && std::isfinite(*uncertainty) && *uncertainty > 0.0 &&
                        std::isfinite(value) && *uncertainty > 1e-12 * std::fabs(value);
    if (!usable) { return rounded_number(value); }
    const int uncertainty_exponent = decimal_exponent(*uncertainty, 2);
    const int value_exponent = value == 0.0 ? uncertainty_exponent : decimal_exponent(std::fabs(value), 3);
    const int leading = std::max(value_exponent, uncertainty_exponent);
    const int last_digit = uncertainty_exponent - 1;
    const std::string in_brackets =
        std::string("(").append(fixed_decimal(scaled_down(*uncertainty, last_digit), 0)).append(")");
    if (reads_better_with_power(leading) || last_digit > 0) {
        return fixed_decimal(scaled_down(value, leading), leading - last_digit) + in_brackets + "×" +
               power_of_ten(leading);
    }
    return fixed_decimal(value, -last_digit) + in_brackets;
}

}  // namespace gyrolog
