#include "analysis/noise/average_covariance.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace gyrolog {
namespace {

double angle_noise(std::int64_t lag, double span_s) {
    const double end = 1.0 / (span_s * span_s);
    return lag == 0 ? 2.0 * end : (lag == 1 ? -end : 0.0);
}

double white(std::int64_t lag, double span_s) { return lag == 0 ? 1.0 / span_s : 0.0; }

double flicker(std::int64_t lag, double) {
    const auto t2_log_t = [](double t) { return t == 0.0 ? 0.0 : t * t * std::log(t); };
    const auto d = static_cast<double>(lag);
    // Far apart the differences lose their digits, and the series needs two terms.
    if (d > 1000.0) { return -(2.0 * std::log(d) + 3.0 - 1.0 / (6.0 * d * d)) / (2.0 * pi); }
    return (2.0 * t2_log_t(d) - t2_log_t(std::abs(d - 1.0)) - t2_log_t(d + 1.0)) / (2.0 * pi);
}

double random_walk(std::int64_t lag, double span_s) {
    return lag == 0 ? -span_s / 6.0 : -span_s * static_cast<double>(lag) / 2.0;
}

}  // namespace

AverageCovariance average_covariance(NoiseTerm term) {
    switch (term) {
        case NoiseTerm::Q:
            return {angle_noise, true};
        case NoiseTerm::B:
            return {flicker, false};
        case NoiseTerm::K:
            return {random_walk, false};
        case NoiseTerm::N:
        case NoiseTerm::R:
            break;
    }
    return {white, true};
}

AverageCovariance gauss_markov_covariance(double correlation_s) {
    return {[=](std::int64_t lag, double span_s) {
                const double x = span_s / correlation_s;
                if (lag == 0) {  // The closed form loses its digits where x is small.
                    return x < 1e-2 ? 1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0)))
                                    : 2.0 * (x - 1.0 + std::exp(-x)) / (x * x);
                }
                // ((1 - exp(-x)) / x)^2 exp(-(lag - 1) x)
                const double within = -std::expm1(-x) / x;
                return within * within * std::exp(-static_cast<double>(lag - 1) * x);
            },
            false};
}

AverageCovariance filtered_white_covariance(double bandwidth_hz, double rate_hz) {
    using Complex = std::complex<double>;
    const double q = 2.0 * pi * bandwidth_hz / (std::numbers::sqrt2 * rate_hz);
    const Complex z = std::exp(Complex(-q, q));
    const Complex shape(1.0, -1.0);
    // The sum of all covariances is the density at low frequencies, times the rate.
    const double sum = 1.0 + 2.0 * (shape * z / (1.0 - z)).real();
    const Complex C = shape * (rate_hz / sum);
    return {[=](std::int64_t lag, double span_s) {
                const double m = std::round(span_s * rate_hz);
                const Complex z_m = std::exp(Complex(-q, q) * m);
                if (lag == 0) {
                    const Complex pairs = z * (m * (1.0 - z) - (1.0 - z_m)) / ((1.0 - z) * (1.0 - z));
                    return (m * C.real() + 2.0 * (C * pairs).real()) / (m * m);
                }
                const Complex within = (1.0 - z_m) / (1.0 - z);
                const double between = static_cast<double>(lag - 1) * m + 1.0;
                return (C * within * within * std::exp(Complex(-q, q) * between)).real() / (m * m);
            },
            true};
}

AverageCovariance sinusoid_covariance(double frequency_hz, double rate_hz) {
    return {[=](std::int64_t lag, double span_s) {
                const double m = std::round(span_s * rate_hz);
                const double one = std::sin(pi * frequency_hz / rate_hz);
                const double kept =
                    std::abs(one) < 1e-12 ? 1.0 : std::sin(pi * frequency_hz * span_s) / (m * one);
                const double phase = 2.0 * pi * frequency_hz * span_s * static_cast<double>(lag);
                return 0.5 * kept * kept * std::cos(phase);
            },
            false};
}

}  // namespace gyrolog
