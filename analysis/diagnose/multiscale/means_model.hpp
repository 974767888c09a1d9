// What is left of a sensor in means of its samples.
#pragma once

#include <complex>
#include <cstddef>

#include "analysis/diagnose/report.hpp"
#include "analysis/simulate/effect_signature.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

// What means of `samples` at `rate_hz` have of a line, in rows counted from their first samples: its height
// and how far its phase is ahead, Dirichlet's kernel.
std::complex<double> line_in_means(double f_hz, double rate_hz, std::size_t samples);

// Of samples that were taken at `rate_hz`. As white as they were are what is white and what the converter
// adds; lines are as high as means have them, and folded by them, single samples off by as much less; what
// does not show is left out. Holds for what else changes little within `samples`.
SensorModel model_of_means(SensorModel model, std::size_t samples, double rate_hz);

// What was found in means, for a model of the samples.
Finding finding_of_samples(Finding finding, std::size_t samples, double rate_hz);

}  // namespace gyrolog
