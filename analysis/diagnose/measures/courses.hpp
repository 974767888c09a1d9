// Courses over time, in 32 equal parts of the record: ln of the whitened samples' variance, and their mean in
// standard deviations. x is in s from the first sample.
#pragma once

#include "analysis/diagnose/measures/measure.hpp"

namespace gyrolog {

namespace measures {
extern const Measure course;
extern const Measure drift;
}  // namespace measures

void add_course_curves(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

}  // namespace gyrolog
