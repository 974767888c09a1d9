// Which power laws a signal holds, and how much of each, read from its overlapping Allan curve.
//
// At a long averaging time a record has few independent differences, and they cannot tell which noise made
// them; shorter times can. So the law at any time, for any kind of deviation, is taken from a fit to the
// whole curve:
//
//   sigma^2(m) = sum over laws of level * E(m),  level >= 0,  E(m): difference_covariance.hpp
//
// by maximum likelihood, each variance taken as chi-square with its own degrees of freedom. Of all sets of
// laws the one with the least deviance + 4 for each law is taken: a law has to stand out by two standard
// deviations. No variance is trusted to better than 5 %: noise that follows no power law at short times (an
// on-chip filter, a tone) shall not decide what is found at long ones.
#pragma once

#include <cstdint>
#include <span>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/power_law.hpp"

namespace gyrolog {

struct PowerLawLevels {
    std::array<double, power_laws> level{};  // indexed by PowerLaw, in the units of difference_covariance.hpp

    // How the laws share the square of any deviation at m samples.
    VarianceShares shares(const DeviationRule& rule, std::int64_t m) const;
};

// One point an octave at most, of kind `overlapping`: neighbours closer than that say the same again. White
// rate noise where no variance is above zero.
PowerLawLevels fit_power_laws(std::span<const AllanPoint> octaves, std::span<const Segment> segments,
                              PhaseConvention convention);

}  // namespace gyrolog
