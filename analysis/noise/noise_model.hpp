// The sensor's noise: coefficients of the rate noise by IEEE Std 952-1997 annex C, in SI units.
//
// Two-sided power spectral density of the rate noise:
//   S(f) = N^2 + B^2 / (2 pi f) + (K / (2 pi f))^2 + R^2 / (2 pi f)^3 + (2 pi f Q)^2
// Allan variance:
//   sigma^2(tau) = N^2 / tau + (2 ln 2 / pi) B^2 + K^2 tau / 3 + R^2 tau^2 / 2 + 3 Q^2 / tau^2
#pragma once

#include <array>

namespace gyrolog {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double rad_per_deg = pi / 180.0;
inline constexpr double deg_per_rad = 180.0 / pi;

struct NoiseCoefficients {
    double Q_rad = 0.0;               // quantisation noise of the angle
    double N_rad_per_sqrt_s = 0.0;    // angle random walk = (rad/s)/sqrt(Hz)
    double B_rad_per_s = 0.0;         // bias instability
    double K_rad_per_s_sqrt_s = 0.0;  // rate random walk = (rad/s) sqrt(Hz)
    double R_rad_per_s2 = 0.0;        // rate ramp

    double allan_variance(double tau_s) const;  // (rad/s)^2
    double psd(double f_hz) const;              // two-sided, (rad/s)^2/Hz
};

}  // namespace gyrolog
