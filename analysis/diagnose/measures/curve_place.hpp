// Where on a curve the gap lies, for the measures' places.
#pragma once

#include <optional>
#include <vector>

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

// The function returns the span of x whose points are three standard deviations off or more, or, where none
// is, seven tenths of the worst.
std::optional<Span> span_outside(const GapCurve& curve, const std::vector<double>& z);

// x of the point that is furthest off.
Span worst_point(const GapCurve& curve, const std::vector<double>& z);

// Measures along one of these axes put span_outside() into the place.
void locate_averaging_times(const GapCurve& curve, const std::vector<double>& z, Place& where);
void locate_frequencies(const GapCurve& curve, const std::vector<double>& z, Place& where);
void locate_times(const GapCurve& curve, const std::vector<double>& z, Place& where);
void locate_rates(const GapCurve& curve, const std::vector<double>& z, Place& where);

// A measure along periods puts worst_point() there: multiples and parts of a period stand out with it.
void locate_period(const GapCurve& curve, const std::vector<double>& z, Place& where);

}  // namespace gyrolog
