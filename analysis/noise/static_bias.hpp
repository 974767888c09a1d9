// Static bias: the mean of a record at rest, with the uncertainty its own noise leaves.
#pragma once

#include "analysis/noise/noise_fit.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

struct StaticBias {
    double value = 0.0;                 // unit of the column
    double sample_sd = 0.0;             // of single samples
    double excess_kurtosis = 0.0;       // of single samples; 0 for a Gaussian
    double expanded_uncertainty = 0.0;  // coverage_factor times the standard uncertainty (JCGM 100:2008, 6.2)
    double coverage_factor = 2.0;       // for a coverage of 95.45 %
    double effective_samples = 0.0;     // as many independent samples would give this uncertainty
};

// For a coverage of 95.45 % with an uncertainty that is known with so many degrees of freedom; 0: well known.
double coverage_factor(double dof);

// Standard uncertainty: the Allan deviation of the fit's sparse model at an averaging time of the whole
// record, that is the root of half the mean square difference between the mean of this record and that of one
// like it right after. For white noise it is the standard deviation over sqrt(n); for flicker and random walk
// no number of samples gets below it.
//
// Coverage factor: 2 where the noise is well known; where the fit knows that variance with few degrees of
// freedom, Student's t for as many (JCGM 100:2008, G.3 and G.4).
StaticBias static_bias(const Column& column, double rate_hz, const NoiseFit& fit);

}  // namespace gyrolog
