#include "analysis/simulate/portable_math.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace gyrolog {

namespace {

// ln 2 in two parts; the first has 32 trailing zero bits, so that k * ln2_high is exact for |k| < 2^20.
constexpr double ln2_high = 6.93147180369123816490e-01;
constexpr double ln2_low = 1.90821492927058770002e-10;

template <std::size_t size>
double polynomial(const std::array<double, size>& coefficients, double x) {
    double sum = coefficients[size - 1];
    for (std::size_t i = size - 1; i-- > 0;) { sum = sum * x + coefficients[i]; }
    return sum;
}

double rational(const std::array<double, 8>& numerator, const std::array<double, 8>& denominator, double x) {
    return polynomial(numerator, x) / polynomial(denominator, x);
}

// The three regions of AS 241: |p - 1/2| <= 0.425, then r = sqrt(-ln p) up to 5 and beyond.
constexpr std::array<double, 8> central_numerator = {
    3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
    4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3};
constexpr std::array<double, 8> central_denominator = {1.0,
                                                       4.2313330701600911252e1,
                                                       6.8718700749205790830e2,
                                                       5.3941960214247511077e3,
                                                       2.1213794301586595867e4,
                                                       3.9307895800092710610e4,
                                                       2.8729085735721942674e4,
                                                       5.2264952788528545610e3};
constexpr std::array<double, 8> middle_numerator = {1.42343711074968357734e0,  4.63033784615654529590e0,
                                                    5.76949722146069140550e0,  3.64784832476320460504e0,
                                                    1.27045825245236838258e0,  2.41780725177450611770e-1,
                                                    2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr std::array<double, 8> middle_denominator = {1.0,
                                                      2.05319162663775882187e0,
                                                      1.67638483018380384940e0,
                                                      6.89767334985100004550e-1,
                                                      1.48103976427480074590e-1,
                                                      1.51986665636164571966e-2,
                                                      5.47593808499534494600e-4,
                                                      1.05075007164441684324e-9};
constexpr std::array<double, 8> far_numerator = {6.65790464350110377720e0,  5.46378491116411436990e0,
                                                 1.78482653991729133580e0,  2.96560571828504891230e-1,
                                                 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                                 2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr std::array<double, 8> far_denominator = {1.0,
                                                   5.99832206555887937690e-1,
                                                   1.36929880922735805310e-1,
                                                   1.48753612908506148525e-2,
                                                   7.86869131145613259100e-4,
                                                   1.84631831751005468180e-5,
                                                   1.42151175831644588870e-7,
                                                   2.04426310338993978564e-15};

}  // namespace

double portable_log(double x) {
    // x = m 2^k with m in [0.70, 1.41); ln m = 2 artanh((m - 1) / (m + 1)), whose series ends below the last
    // bit.
    constexpr std::uint64_t mantissa_mask = (std::uint64_t{1} << 52U) - 1U;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    auto k = static_cast<int>(bits >> 52U) - 1023;
    auto m = std::bit_cast<double>((bits & mantissa_mask) | (std::uint64_t{1023} << 52U));
    if (m > 1.41421356) {
        m *= 0.5;
        ++k;
    }
    const double s = (m - 1.0) / (m + 1.0);
    const double s2 = s * s;
    double series = 0.0;
    for (int n = 25; n >= 3; n -= 2) { series = (series + 1.0 / n) * s2; }
    return k * ln2_high + (2.0 * s + (2.0 * s * series + k * ln2_low));
}

double portable_exp(double x) {
    const double k = std::floor(x * 1.44269504088896340736 + 0.5);
    const double r = (x - k * ln2_high) - k * ln2_low;
    double series = 1.0;
    for (int n = 14; n >= 1; --n) { series = 1.0 + series * r / n; }
    return std::ldexp(series, static_cast<int>(k));
}

double upper_normal_quantile(double p) {
    const double q = 0.5 - p;
    if (q <= 0.425) { return q * rational(central_numerator, central_denominator, 0.180625 - q * q); }
    const double r = std::sqrt(-portable_log(p));
    return r <= 5.0 ? rational(middle_numerator, middle_denominator, r - 1.6)
                    : rational(far_numerator, far_denominator, r - 5.0);
}

double portable_sine_of_turns(double turns) {
    double rest = turns - std::floor(turns + 0.5);
    if (rest > 0.25) { rest = 0.5 - rest; }
    if (rest < -0.25) { rest = -0.5 - rest; }
    // Taylor's series up to x^21 leaves 1e-18 at a quarter turn.
    const double x = 6.283185307179586 * rest;
    const double square = x * x;
    double sum = 0.0;
    for (int n = 20; n >= 2; n -= 2) { sum = (1.0 + sum) * (-square / (n * (n + 1.0))); }
    return x * (1.0 + sum);
}

}  // namespace gyrolog
