// The telegraph filter gives the likelihoods of averages of a rate in which, beside drift and white noise,
// something jumps between two levels, or wanders with the same covariance.
#pragma once

#include <span>

#include "analysis/diagnose/estimators/drift_states.hpp"

namespace gyrolog {

// `distance` is that of the levels, in the unit of the averages.
struct Telegraph {
    double distance = 0.0;  // of the levels
    double high_s = 1.0;    // mean dwell times
    double low_s = 1.0;

    double high_share() const { return high_s / (high_s + low_s); }
    double variance() const { return distance * distance * high_share() * (1.0 - high_share()); }
    double correlation_s() const { return high_s * low_s / (high_s + low_s); }
};

// The filter is two Kalman filters, one for each level. At every step each goes on along both ways, staying
// and changing, and what comes to the same level is merged: the generalised pseudo-Bayes filter of second
// order (Y. Bar-Shalom, X. R. Li, T. Kirubarajan, Estimation with Applications to Tracking and Navigation,
// 2001, 11.6). It is exact without drift, where it is the forward recursion of a hidden Markov chain, but for
// averages in which the level changes more than once; one in which it changes is taken to lie anywhere
// between the levels. The likelihood is in nats, with all constants.
double telegraph_log_likelihood(std::span<const double> averages, double step_s, const DriftStates& noise,
                                const Telegraph& telegraph);

// The same for Gauss-Markov noise of the telegraph's variance and correlation time: one Kalman filter.
double gauss_markov_log_likelihood(std::span<const double> averages, double step_s, const DriftStates& noise,
                                   const Telegraph& telegraph);

}  // namespace gyrolog
