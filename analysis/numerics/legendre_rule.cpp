#include "analysis/numerics/legendre_rule.hpp"

#include <cstddef>

#include <boost/math/quadrature/gauss.hpp>

namespace gyrolog {

const std::array<LegendreNode, 4>& legendre_rule_of_seven() {
    using Gauss = boost::math::quadrature::gauss<double, 7>;
    static const std::array<LegendreNode, 4> rule = [] {
        std::array<LegendreNode, 4> nodes;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            nodes.at(i) = {Gauss::abscissa().at(i), Gauss::weights().at(i)};
        }
        return nodes;
    }();
    return rule;
}

}  // namespace gyrolog
