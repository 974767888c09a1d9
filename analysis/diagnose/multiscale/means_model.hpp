// The model of means is what is left of a sensor in means of its samples.
#pragma once

#include <complex>
#include <cstddef>

#include "analysis/diagnose/report.hpp"
#include "analysis/simulate/effect_signature.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// The function returns what means of `samples` at `rate_hz` have of a line, in rows counted from their first
// samples: its height and how far its phase is ahead, Dirichlet's kernel.
std::complex<double> line_in_means(double f_hz, double rate_hz, std::size_t samples);

// The function turns a model of samples that were taken at `rate_hz` into one of their means. What is white,
// and what the converter adds, is as white as it was. Lines are as high as means have them, and folded by
// them; single samples are off by as much less. What does not show is left out. The rest is taken to change
// little within `samples`.
SensorModel model_of_means(SensorModel model, std::size_t samples, double rate_hz);

// The function turns what was found in means into what a model of the samples has.
Finding finding_of_samples(Finding finding, std::size_t samples, double rate_hz);

}  // namespace gyrolog
