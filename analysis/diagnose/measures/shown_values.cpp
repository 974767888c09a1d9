#include "analysis/diagnose/measures/shown_values.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

namespace {

constexpr double db_per_neper = 20.0 / std::numbers::ln10;  // of an amplitude

}  // namespace

double as_it_is(double value) { return value; }
double in_degrees(double angle_rad) { return angle_rad * deg_per_rad; }
double variance_dB(double log_variance) { return 0.5 * db_per_neper * log_variance; }

double cube_root_dB(double cube_root_less_1) {
    return 1.5 * db_per_neper * std::log(std::max(1.0 + cube_root_less_1, 0.2));
}

}  // namespace gyrolog
