// Power-law noise: which kind dominates an average of m samples, and how strongly its Allan differences are
// correlated, which decides how much an Allan deviation is worth.
//
// The names are those of a rate sensor; in brackets the clock's name and the exponent of the rate's spectrum.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace gyrolog {

enum class PowerLaw {
    white_angle,    // quantisation, Q  (white phase, f^2)
    flicker_angle,  //                  (flicker phase, f^1)
    white_rate,     // angle random walk, N  (white frequency, f^0)
    flicker_rate,   // bias instability, B   (flicker frequency, f^-1)
    rate_walk,      // rate random walk, K   (random-walk frequency, f^-2)
};
inline constexpr std::size_t power_laws = 5;

// How the Allan variance divides among the power laws, indexed by PowerLaw. Need not sum to 1.
using VarianceShares = std::array<double, power_laws>;

// The dominating power law of a series of contiguous averages (NaN: an average that does not exist).
// Thirty averages or more: by the lag-1 autocorrelation, differencing while it is too high (NIST SP 1065,
// section 5.5; Riley and Greenhall 2004). Four to twenty-nine: by the ratio of sample variance to Allan
// variance against Barnes' B1. Fewer, or averages that do not vary: nothing.
std::optional<PowerLaw> identify_power_law(std::span<const double> averages);

// How many independent differences the overlapping ones are worth: equivalent degrees of freedom of the mean
// of squared Allan differences at averaging factor m, in runs of so many neighbouring differences each, one
// at every `stride` samples (1: overlapping, m: standard):
//
//   edf = (sum of terms)^2 / sum over runs, lags j of (terms - |j|) rho(j stride)^2
//
// rho: autocorrelation of the Allan difference (Greenhall and Riley 2003, "Uncertainty of stability variances
// based on finite differences", eqs. 9-13; NIST SP 1065 section 5.4.1), summed over all lags below 4m instead
// of by their tables. Differences of different runs are taken as independent.
class DegreesOfFreedom {
public:
    // For mixtures of these laws only: the sums over lags are taken here, once.
    DegreesOfFreedom(std::span<const PowerLaw> laws, std::int64_t m, std::int64_t stride,
                     std::span<const std::int64_t> terms_of_runs);

    // 0 without any difference.
    double of(const VarianceShares& shares) const;
    double of(PowerLaw law) const;

private:
    std::array<std::array<double, power_laws>, power_laws> products_{};  // sums over lags of rho_a rho_b
    double terms_ = 0.0;
};

}  // namespace gyrolog
