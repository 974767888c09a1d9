// The top of a function of one variable, by golden-section search (J. Kiefer, Proc. AMS 4, 1953).
#pragma once

#include <numbers>

namespace gyrolog {

// Where `value` is largest between `from` and `to`, to `tolerance_rel` of their distance; `value` has one top
// there. What a likelihood loses by the default is 1e-10 of what it falls by over the whole distance, were it
// a parabola.
template <typename Function>
double place_of_top(Function value, double from, double to, double tolerance_rel = 1e-5) {
    constexpr double kept = std::numbers::phi - 1.0;
    const double tolerance = tolerance_rel * (to - from);
    double left = to - kept * (to - from);
    double right = from + kept * (to - from);
    double at_left = value(left);
    double at_right = value(right);
    while (to - from > tolerance) {
        if (at_left > at_right) {
            to = right;
            right = left;
            at_right = at_left;
            left = to - kept * (to - from);
            at_left = value(left);
        } else {
            from = left;
            left = right;
            at_left = at_right;
            right = from + kept * (to - from);
            at_right = value(right);
        }
    }
    return 0.5 * (from + to);
}

}  // namespace gyrolog
