// How strongly the terms of a deviation are correlated, and how large they are expected to be, for power-law
// noise.
//
// theta of power-law noise has no covariance, but a generalised one s(t), defined up to polynomials that the
// differences take away (Greenhall and Riley 2003, "Uncertainty of stability variances based on finite
// differences", eqs. 9-10). With samples j as the unit of t and up to a constant factor:
//
//   white angle    delta(t)                      flicker angle   -log|t|, averaged over one sample
//   white rate     -|t|                          flicker rate    t^2 log|t|
//   rate walk      |t|^3 - |t|
//
// White and walk are exact for sampled noise and its running sums; both flickers are those of a continuous
// rate averaged over each sample. A difference of order d over m has covariance (-1)^d delta_m^{2d} s(t),
// with delta_m the central difference. A mean of m neighbouring differences (modified) is a difference one
// order higher of theta summed once more, over m; summing once more is: white angle -> -|t| and so on
// upwards.
#pragma once

#include <cstdint>

#include "analysis/allan/deviation_rule.hpp"
#include "analysis/allan/power_law.hpp"

namespace gyrolog {

class DifferenceCovariance {
public:
    DifferenceCovariance(PowerLaw law, const DeviationRule& rule, std::int64_t m);

    // Of two terms whose first points are so many samples apart. The unit differs from law to law, but not
    // with the lag, m or the kind.
    double at(double lag) const;

    // at(lag) / at(0).
    double correlation(double lag) const { return at(lag) / variance_; }

    // Of the terms of total deviation about points i and j of a stretch of so many points, reflected about
    // its ends; order 2 only.
    double reflected(double i, double j, double points) const;

    // The expected square of the deviation, in that unit; bias by reflection left aside.
    double expected_variance() const { return variance_ / norm_; }

private:
    double generalised(double lag) const;

    PowerLaw law_;
    bool summed_;  // theta is summed once more
    int order_;
    double m_;
    double norm_;
    double variance_;
};

}  // namespace gyrolog
