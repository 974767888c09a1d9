// The sensor's noise: coefficients of the rate noise by IEEE Std 952-1997 annex C, in SI units.
//
// Two-sided power spectral density of the rate noise:
//   S(f) = N^2 + B^2 / (2 pi f) + (K / (2 pi f))^2 + R^2 / (2 pi f)^3 + (2 pi f Q)^2
// Allan variance:
//   sigma^2(tau) = N^2 / tau + (2 ln 2 / pi) B^2 + K^2 tau / 3 + R^2 tau^2 / 2 + 3 Q^2 / tau^2
#pragma once

#include <vector>

namespace gyrolog {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double rad_per_deg = pi / 180.0;
inline constexpr double deg_per_rad = 180.0 / pi;
inline constexpr double s_per_h = 3600.0;

struct NoiseCoefficients {
    double Q_rad = 0.0;               // quantisation noise of the angle
    double N_rad_per_sqrt_s = 0.0;    // angle random walk = (rad/s)/sqrt(Hz)
    double B_rad_per_s = 0.0;         // bias instability
    double K_rad_per_s_sqrt_s = 0.0;  // rate random walk = (rad/s) sqrt(Hz)
    double R_rad_per_s2 = 0.0;        // rate ramp

    double allan_variance(double tau_s) const;  // (rad/s)^2
    double psd(double f_hz) const;              // two-sided, (rad/s)^2/Hz

    bool operator==(const NoiseCoefficients&) const = default;
};

// First-order Gauss-Markov noise, correlation exp(-t / T) (IEEE Std 952-1997 C.1.5, with q_c^2 T = 2
// sigma^2):
//   S(f) = 2 sigma^2 T / (1 + (2 pi f T)^2)
//   sigma^2(tau) = 2 sigma^2 T / tau (1 - T / (2 tau) (3 - 4 exp(-tau / T) + exp(-2 tau / T)))
struct GaussMarkov {
    double sigma_rad_per_s = 0.0;
    double correlation_s = 0.0;

    double allan_variance(double tau_s) const;
    double psd(double f_hz) const;
};

// A sin(2 pi f t + phase) (IEEE Std 952-1997 C.1.6): sigma^2(tau) = A^2 (sin^2(pi f tau) / (pi f tau))^2. A
// line has no spectral density.
struct Sinusoid {
    double amplitude_rad_per_s = 0.0;
    double frequency_hz = 0.0;

    double allan_variance(double tau_s) const;
};

// Error of a converter with a given step, as white noise of variance step^2 / 12 a sample.
struct RateQuantisation {
    double step_rad_per_s = 0.0;
    double rate_hz = 1.0;  // at which it samples

    double density() const { return step_rad_per_s * step_rad_per_s / (12.0 * rate_hz); }  // two-sided
};

// Everything that a still sensor's noise is described by. Independent of each other: variances add.
struct NoiseModel {
    NoiseCoefficients coefficients;
    std::vector<GaussMarkov> gauss_markov{};
    std::vector<Sinusoid> sinusoids{};
    RateQuantisation converter{};

    double allan_variance(double tau_s) const;
    double psd(double f_hz) const;  // without the sinusoids
};

}  // namespace gyrolog
