#include "analysis/diagnose/measures/gap_curves.hpp"

#include "analysis/diagnose/measures/allan.hpp"
#include "analysis/diagnose/measures/amplitude.hpp"
#include "analysis/diagnose/measures/codes.hpp"
#include "analysis/diagnose/measures/courses.hpp"
#include "analysis/diagnose/measures/cross_axis.hpp"
#include "analysis/diagnose/measures/model_parameters.hpp"
#include "analysis/diagnose/measures/narrow_lines.hpp"
#include "analysis/diagnose/measures/noise_level.hpp"
#include "analysis/diagnose/measures/period.hpp"
#include "analysis/diagnose/measures/rate_change.hpp"
#include "analysis/diagnose/measures/reference_rate.hpp"
#include "analysis/diagnose/measures/repeats.hpp"
#include "analysis/diagnose/measures/spectrum.hpp"
#include "analysis/diagnose/measures/temperature.hpp"

namespace gyrolog {

namespace {

using AddCurves = void (*)(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves);

// In the order of the report.
constexpr AddCurves of_each_axis[] = {
    add_allan_curve,           add_spectrum_curve,    add_narrow_curve,          add_course_curves,
    add_amplitude_curves,      add_repeats_curve,     add_period_curve,          add_codes_curve,
    add_temperature_curve,     add_cross_axis_curves, add_reference_rate_curves, add_rate_change_curves,
    add_model_parameter_curves};

}  // namespace

std::vector<GapCurve> gap_curves(const Observation& observation) {
    std::vector<GapCurve> curves;
    for (const std::size_t axis : observation.prediction().axes()) {
        for (const AddCurves add : of_each_axis) { add(observation, axis, curves); }
    }
    add_noise_level_curves(observation, curves);
    if (!observation.prediction().noise_is_sensors()) {
        std::erase_if(curves, [](const GapCurve& curve) { return curve.measure->is_of_noise; });
    }
    return curves;
}

bool are_alike(const GapCurve& a, const GapCurve& b) {
    return a.measure == b.measure && a.axis == b.axis && a.other == b.other &&
           a.of_all_axes == b.of_all_axes && a.value.size() == b.value.size();
}

}  // namespace gyrolog
