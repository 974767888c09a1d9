// Gauss-Legendre quadrature: integral over -1 to 1 of f = sum weight f(x), exact for polynomials up to
// degree 13.
#pragma once

#include <array>

namespace gyrolog {

struct LegendreNode {
    double x = 0.0;  // the one at -x has the same weight
    double weight = 0.0;
};

// The seven nodes, those at x >= 0, by rising x: the first is 0, which stands alone.
const std::array<LegendreNode, 4>& legendre_rule_of_seven();

}  // namespace gyrolog
