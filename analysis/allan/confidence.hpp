// Confidence interval of a deviation by chi-square (NIST SP 1065, section 5.3.2).
#pragma once

namespace gyrolog {

struct Interval {
    double lo = 0.0;
    double hi = 0.0;
};

// Of the true deviation, given the estimate and its equivalent degrees of freedom; `confidence` between 0 and
// 1, equal tails: lo = s sqrt(edf / chi2_{(1+p)/2}), hi = s sqrt(edf / chi2_{(1-p)/2}).
Interval chi_square_interval(double deviation, double edf, double confidence);

// The textbook's, of the deviation of n averages: relative error 1 / sqrt(2 (n - 1)) (IEEE Std 952-1997
// annex C), taken as one sigma of a normal variable; lo not below 0. Right for many averages of white noise
// only.
Interval textbook_interval(double deviation, double averages, double confidence);

}  // namespace gyrolog
