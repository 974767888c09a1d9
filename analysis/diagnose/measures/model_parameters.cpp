#include "analysis/diagnose/measures/model_parameters.hpp"

#include <array>

#include "analysis/diagnose/measures/shown_values.hpp"

namespace gyrolog {

namespace definition {

// In stated standard deviations the likelihood charges half the square. What a recording hardly tells stays
// near 0 in every simulation, and is off by no more than the model says.
constexpr double least_sd_of_stated = 1.0;

}  // namespace definition

namespace {

constexpr std::array coefficient_names = {"N", "B", "K"};

// It is of no frequency and no time.
void parameter_has_no_place(const GapCurve& /*curve*/, const std::vector<double>& /*z*/, Place& /*where*/) {}

}  // namespace

const Measure measures::noise_coefficients{.name = "noise coefficients",
                                           .x_name = "coefficient",
                                           .y_name = "off (stated sd)",
                                           .shown_x = as_it_is,
                                           .shown_y = as_it_is,
                                           .locate = parameter_has_no_place,
                                           .categories = coefficient_names,
                                           .is_course = false,
                                           .least_sd = definition::least_sd_of_stated,
                                           .is_of_noise = true};
const Measure measures::motion_parameters{.name = "gains, latency and clock",
                                          .x_name = "parameter",
                                          .y_name = "off (stated sd)",
                                          .shown_x = as_it_is,
                                          .shown_y = as_it_is,
                                          .locate = parameter_has_no_place,
                                          .is_course = false,
                                          .least_sd = definition::least_sd_of_stated};

void add_model_parameter_curves(const Observation& observation, std::size_t axis,
                                std::vector<GapCurve>& curves) {
    const AxisObservation& seen = observation.axis(axis);
    curves.push_back({&measures::noise_coefficients,
                      axis,
                      axis,
                      {1.0, 2.0, 3.0},
                      {seen.noise.z.begin(), seen.noise.z.end()}});
    const UncertainMean& uncertain = observation.prediction().uncertain(axis);
    if (uncertain.empty()) { return; }
    GapCurve motion{&measures::motion_parameters, axis, axis, {}, {}};
    for (std::size_t u = 0; u < uncertain.size(); ++u) {
        motion.x.push_back(static_cast<double>(u + 1));
        motion.value.push_back(seen.uncertain_fit[u] / uncertain[u].sd);
    }
    curves.push_back(std::move(motion));
}

}  // namespace gyrolog
