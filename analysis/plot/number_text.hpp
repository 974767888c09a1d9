// Numbers as people print them.
#pragma once

#include <optional>
#include <string>

namespace gyrolog {

std::string power_of_ten(int exponent);  // "10⁻³"

// Plain decimals, rounded: fixed_decimal(-0.25, 1) is "−0.3" or "−0.2", with a true minus sign; never "−0".
std::string fixed_decimal(double value, int decimals);

// With that many significant digits: "0.0512", "4.90", "2.10×10⁻⁵". Powers of ten outside 0.001 to 10 000.
std::string rounded_number(double value, int significant_digits = 3);

// The same without zeros at its end: "3", "12.5". For settings, which are exact.
std::string short_number(double value, int significant_digits = 3);

// The short form of GUM:2008 7.2.2 example 2, two digits of the standard uncertainty: "5.12(13)×10⁻³".
// Without a usable uncertainty, or one beyond what a double can tell apart, three digits of the value alone.
std::string number_with_uncertainty(double value, std::optional<double> uncertainty);

}  // namespace gyrolog
