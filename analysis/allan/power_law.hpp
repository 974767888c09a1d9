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

}  // namespace gyrolog
