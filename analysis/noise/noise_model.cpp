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

}  // namespace gyrolog
