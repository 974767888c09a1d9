// A comparison for programs: schema gyrolog-compare/1.
//
//   recording, other         names
//   with                     "simulations" or "recording"
//   simulations, seed, band_probability     with simulations only
//   rate_hz, duration_s, samples, less_reference
//   sensor                   "accelerometer" where it was that; its numbers are in g where a gyro has dps
//   axes.x.allan             tau_s, recording, other (the simulations' median), lo, hi (their band) in dps;
//                            recording_lo, recording_hi with a recording only; ratio_dB = recording over
//                            other. All arrays of one length.
//   axes.x.spectrum          the same by f_hz, in dps/sqrt(Hz): root of the two-sided density
//   .outside                 [{from, to, worst_at, worst_dB, points}], .points_by_chance,
//   .simulations_outside_as_often, .largest_gap {at, dB, distance, stands_out}
//   axes.x.standard_deviation, skewness, excess_kurtosis
//                            {recording, other, lo, hi, distance, stands_out}; with simulations, else the
//                            first two
//   axes.x.sentence          the outcome in words
//   notes (on the model), warnings
#pragma once

#include <string>

#include "analysis/compare/comparison.hpp"

namespace gyrolog {

std::string comparison_json(const Comparison& comparison);

}  // namespace gyrolog
