#include "analysis/diagnose/measures/rate_change.hpp"

#include "analysis/diagnose/measures/binned_samples.hpp"
#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"

namespace gyrolog {

namespace {

void locate_acceleration(const GapCurve& /*curve*/, const std::vector<double>& /*z*/, Place& where) {
    where.acceleration = true;
}

}  // namespace

const Measure measures::acceleration{.name = "change of the rate",
                                     .x_name = "change of the rate (deg/s^2)",
                                     .y_name = "mean (its sd)",
                                     .shown_x = in_degrees,
                                     .shown_y = as_it_is,
                                     .locate = locate_acceleration,
                                     .least_sd = 1.0};
const Measure measures::delay_course{.name = "delay over time",
                                     .x_name = "time (s)",
                                     .y_name = "excess (its sd)",
                                     .shown_x = as_it_is,
                                     .shown_y = as_it_is,
                                     .locate = locate_times,
                                     .least_sd = 1.0};

void add_rate_change_curves(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    // Beside a hole the world turns along a straight line to what is behind it: no change that is known.
    if (!observation.prediction().world().reference_changes()) { return; }
    const std::vector<float>& change = observation.prediction().response_change_rad_s2(axis);
    if (!varies(change)) { return; }
    curves.push_back(mean_curve(measures::acceleration, axis, axis,
                                by_value(observation, axis, change, equal_counts(observation, change))));
    curves.push_back(drive_curve(measures::delay_course, observation, axis, change));
}

}  // namespace gyrolog
