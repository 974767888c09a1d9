// Power-law noise.
//
// The names are those of a rate sensor; in brackets the clock's name and the exponent of the rate's spectrum.
#pragma once

#include <array>
#include <cstddef>

namespace gyrolog {

enum class PowerLaw {
    white_angle,    // quantisation, Q  (white phase, f^2)
    flicker_angle,  //                  (flicker phase, f^1)
    white_rate,     // angle random walk, N  (white frequency, f^0)
    flicker_rate,   // bias instability, B   (flicker frequency, f^-1)
    rate_walk,      // rate random walk, K   (random-walk frequency, f^-2)
};
inline constexpr std::size_t power_laws = 5;
inline constexpr std::array all_power_laws = {PowerLaw::white_angle, PowerLaw::flicker_angle,
                                              PowerLaw::white_rate, PowerLaw::flicker_rate,
                                              PowerLaw::rate_walk};

constexpr std::size_t index_of(PowerLaw law) { return static_cast<std::size_t>(law); }

// How a variance divides among the power laws, indexed by PowerLaw. Need not sum to 1.
using VarianceShares = std::array<double, power_laws>;

}  // namespace gyrolog
