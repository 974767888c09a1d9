#include "analysis/diagnose/measures/reference_rate.hpp"

#include "analysis/diagnose/measures/binned_samples.hpp"
#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"

namespace gyrolog {

const Measure measures::rate{.name = "rate about ",
                             .x_name = "reference rate (deg/s)",
                             .y_name = "mean (its sd)",
                             .shown_x = in_degrees,
                             .shown_y = as_it_is,
                             .locate = locate_rates,
                             .names_other = true,
                             .least_sd = 1.0};
const Measure measures::rate_noise{.name = "noise by rate",
                                   .x_name = "reference rate (deg/s)",
                                   .y_name = "over the model (dB)",
                                   .shown_x = in_degrees,
                                   .shown_y = variance_dB,
                                   .locate = locate_rates,
                                   .is_of_noise = true};
const Measure measures::gain_course{.name = "gain over time",
                                    .x_name = "time (s)",
                                    .y_name = "excess (its sd)",
                                    .shown_x = as_it_is,
                                    .shown_y = as_it_is,
                                    .locate = locate_times,
                                    .least_sd = 1.0};

void add_reference_rate_curves(const Observation& observation, std::size_t axis,
                               std::vector<GapCurve>& curves) {
    const Prediction& prediction = observation.prediction();
    if (!prediction.moves()) { return; }
    for (const std::size_t other : prediction.axes()) {
        const std::vector<float>& rate = prediction.true_rate_rad_s(other);
        if (!varies(rate)) { continue; }
        const ValueBins bins = by_value(observation, axis, rate, equal_ranges(rate));
        curves.push_back(mean_curve(measures::rate, axis, other, bins));
        if (other != axis) { continue; }
        curves.push_back(variance_curve(measures::rate_noise, axis, bins));
        curves.push_back(drive_curve(measures::gain_course, observation, axis, rate));
    }
}

}  // namespace gyrolog
