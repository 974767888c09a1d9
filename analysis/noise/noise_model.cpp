#include "analysis/noise/noise_model.hpp"

#include <cmath>
#include <numbers>

namespace gyrolog {

double NoiseCoefficients::allan_variance(double tau_s) const {
    const auto square = [](double x) { return x * x; };
    return 3.0 * square(Q_rad / tau_s) + square(N_rad_per_sqrt_s) / tau_s +
           2.0 * std::numbers::ln2 / pi * square(B_rad_per_s) + square(K_rad_per_s_sqrt_s) * tau_s / 3.0 +
           square(R_rad_per_s2 * tau_s) / 2.0;
}

double NoiseCoefficients::psd(double f_hz) const {
    const double omega = 2.0 * pi * f_hz;
    const auto square = [](double x) { return x * x; };
    return square(omega * Q_rad) + square(N_rad_per_sqrt_s) + square(B_rad_per_s) / omega +
           square(K_rad_per_s_sqrt_s / omega) + square(R_rad_per_s2) / (omega * omega * omega);
}

double GaussMarkov::allan_variance(double tau_s) const {
    const double x = tau_s / correlation_s;
    // The closed form loses its digits where x is small.
    const double shape = x < 1e-2 ? x * x * (1.0 / 3.0 - x / 4.0 + 7.0 * x * x / 60.0)
                                  : 1.0 - (3.0 - 4.0 * std::exp(-x) + std::exp(-2.0 * x)) / (2.0 * x);
    return 2.0 * sigma_rad_per_s * sigma_rad_per_s / x * shape;
}

double GaussMarkov::psd(double f_hz) const {
    const double phase = 2.0 * pi * f_hz * correlation_s;
    return 2.0 * sigma_rad_per_s * sigma_rad_per_s * correlation_s / (1.0 + phase * phase);
}

double Sinusoid::allan_variance(double tau_s) const {
    const double phase = pi * frequency_hz * tau_s;
    const double sine = std::sin(phase);
    const double swing = phase > 0.0 ? amplitude_rad_per_s * sine * sine / phase : 0.0;
    return swing * swing;
}

double NoiseModel::allan_variance(double tau_s) const {
    double sum = coefficients.allan_variance(tau_s) + converter.density() / tau_s;
    for (const GaussMarkov& noise : gauss_markov) { sum += noise.allan_variance(tau_s); }
    for (const Sinusoid& line : sinusoids) { sum += line.allan_variance(tau_s); }
    return sum;
}

double NoiseModel::psd(double f_hz) const {
    double sum = coefficients.psd(f_hz) + converter.density();
    for (const GaussMarkov& noise : gauss_markov) { sum += noise.psd(f_hz); }
    return sum;
}

}  // namespace gyrolog
