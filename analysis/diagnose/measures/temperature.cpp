#include "analysis/diagnose/measures/temperature.hpp"

#include "analysis/diagnose/measures/binned_samples.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"

namespace gyrolog {

namespace {

void locate_temperature(const GapCurve& /*curve*/, const std::vector<double>& /*z*/, Place& where) {
    where.temperature = true;
}

}  // namespace

const Measure measures::temperature{.name = "temperature",
                                    .x_name = "temperature (degC)",
                                    .y_name = "mean (its sd)",
                                    .shown_x = as_it_is,
                                    .shown_y = as_it_is,
                                    .locate = locate_temperature,
                                    .least_sd = 1.0};

void add_temperature_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    const std::vector<float>& temperature_C = observation.prediction().temperature_C();
    if (!varies(temperature_C)) { return; }
    curves.push_back(mean_curve(measures::temperature, axis, axis,
                                by_value(observation, axis, temperature_C, equal_ranges(temperature_C))));
}

}  // namespace gyrolog
