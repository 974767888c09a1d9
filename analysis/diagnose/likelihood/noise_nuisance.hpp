// The noise nuisance is the model's noise coefficients N, B and K, free within their stated uncertainty under
// Whittle's likelihood of binned cosine coefficients (whittle.hpp):
//   -1/2 sum_bins n (ln S + P / S) - 1/2 sum z^2,    coefficient = stated (1 + sd_rel z)
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "analysis/diagnose/likelihood/spectral_bins.hpp"
#include "analysis/simulate/effect_signature.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct NoiseNuisance {
    // By how many stated standard deviations N, B and K differ from the model's.
    std::array<double, 3> z{};
    std::array<double, 3> sd_z{};      // by the likelihood's curvature, the prior's included
    double log_likelihood_nats = 0.0;  // with the prior's -z^2 / 2, without constants
};

// The function returns the relative standard deviations of N, B and K of an axis; 0 where the model states
// none.
std::array<double, 3> noise_uncertainty(const SensorModel& model, std::size_t axis);

// The function fills `density`, by bin, with the sum of the parts whose N, B and K are off by z.
void expected_density(std::span<const SpectralParts> parts, const std::array<double, 3>& sd_rel,
                      const std::array<double, 3>& z, std::span<double> density);

// The function finds the most likely z by Fisher scoring. `power`: by bin, a density as `parts` have it.
// `start`: where to begin.
NoiseNuisance fit_nuisance(const SpectralBins& bins, std::span<const SpectralParts> parts,
                           std::span<const double> power, const std::array<double, 3>& sd_rel,
                           const NoiseNuisance& start = {});

}  // namespace gyrolog
