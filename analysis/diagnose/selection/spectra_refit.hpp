// A spectra refit fits the noise spectra among the causes together. One by one, each is fitted to what the
// others' errors leave, and where two resemble each other over the recording's octaves (flicker noise and a
// random walk, a filter and the level of the white noise, a filter and a band on its skirt) the turns hardly
// move.
//
// The parameters are the logarithms of those that the effects' signatures call spectral. The likelihood is
// Whittle's, with N, B and K of each axis at their most likely (likelihood/noise_nuisance.hpp). The search is
// Fisher scoring (P. J. Green, J. R. Statist. Soc. B 46 (1984) 149) with the information
//   1/2 sum_bins n (d ln S / d a) (d ln S / d b)
// about the parameters and the nuisance, which has its prior. Where it ends, each effect's other forms (a
// filter's order) are tried, all parameters fitted again, until none is better.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/diagnose/likelihood/observation.hpp"
#include "analysis/diagnose/report.hpp"

namespace gyrolog {

struct SpectraRefitOptions {
    // Spectral bins within a band's width at half its height. Of two, none has more than 2 / pi atan(1/2) =
    // 0.3 of the band's power (a Lorentzian); one alone could hide where in it the band is.
    double band_bins_least = 2.0;
};

// `findings`: their entries are those of `seen`'s model from `first_entry` on, in this order. Those of other
// estimators stay as they are, and so do bands that are too narrow for the spectral bins where none was cut.
std::vector<Finding> refit_spectra(const Observation& seen, std::size_t first_entry,
                                   std::vector<Finding> findings, const SpectraRefitOptions& options = {});

}  // namespace gyrolog
