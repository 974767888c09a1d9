// Numbers as people read them.
#pragma once

#include <string>

namespace gyrolog {

// "0.01314 ± 0.00002", or "(1.579 ± 0.010)e-04" for very small and large values: the uncertainty to two
// digits, the value to the same place. An uncertainty of 0, or one that nine decimals
// do not show, is not written.
std::string with_uncertainty(double value, double uncertainty);

// For tables, the short form of GUM:2008 7.2.2 example 2: "0.013144(21)", "1.579(10)e-04". In brackets are
// the two digits of the uncertainty that belong to the value's last two. An uncertainty of 0 is not written.
std::string in_short_form(double value, double uncertainty);

// So many significant digits: "0.0025", "210", and "2.1e+06" only where six digits before the point do not
// do.
std::string in_digits(double value, int digits);

// "12.6 ms", "79.4 s", "3.8 min", "2.78 h": three digits.
std::string duration_text(double seconds);

}  // namespace gyrolog
