// Confidence intervals of a curve, and its degrees of freedom.
//
// Of the true deviation: the estimate over the quantiles of its own distribution (variance_distribution.hpp)
// under the mixture of power laws that holds at that averaging time, equal tails.
#pragma once

#include <functional>
#include <span>

#include "analysis/allan/allan_curve.hpp"
#include "analysis/allan/power_law.hpp"
#include "analysis/recording/recording.hpp"

namespace gyrolog {

// The shares in which power laws make up the expected square at a point (m, tau_s) of the curve; not all 0.
using SharesOfPoint = std::function<VarianceShares(const AllanPoint& point)>;

// Sets lo, hi and edf of every point. `segments` are those of the record that the curve came from. Kind
// `standard_halving` gets its own error (confidence.hpp), whatever the shares are. Curves of more than 400
// points have them worked out at sixteen points an octave and interpolated between.
void set_intervals(AllanCurve& curve, std::span<const Segment> segments, const SharesOfPoint& shares);

}  // namespace gyrolog
