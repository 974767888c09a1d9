#include "analysis/numerics/distributions.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace gyrolog {

using boost::math::complement;
using boost::math::quantile;

double normal_quantile(double p) { return quantile(boost::math::normal(), p); }

double normal_upper_quantile(double tail) { return quantile(complement(boost::math::normal(), tail)); }

double chi_squared_quantile(double degrees, double p) {
    return quantile(boost::math::chi_squared(degrees), p);
}

double chi_squared_upper_quantile(double degrees, double tail) {
    return quantile(complement(boost::math::chi_squared(degrees), tail));
}

double students_t_upper_quantile(double degrees, double tail) {
    return quantile(complement(boost::math::students_t(degrees), tail));
}

double students_t_upper_tail(double degrees, double x) {
    return cdf(complement(boost::math::students_t(degrees), x));
}

double gamma_quantile(double shape, double scale, double p) {
    return quantile(boost::math::gamma_distribution<>(shape, scale), p);
}

double gamma_upper_quantile(double shape, double scale, double tail) {
    return quantile(complement(boost::math::gamma_distribution<>(shape, scale), tail));
}

double gamma_upper_tail(double shape, double x) { return boost::math::gamma_q(shape, x); }

}  // namespace gyrolog
