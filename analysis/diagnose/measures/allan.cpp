#include "analysis/diagnose/measures/allan.hpp"

#include <Eigen/Core>
#include <cmath>

#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"
#include "analysis/noise/noise_model.hpp"

namespace gyrolog::resolution {

constexpr std::size_t allan_places = 8;

}  // namespace gyrolog::resolution

namespace gyrolog {

namespace {

double deviation_dps(double log_deviation) { return std::exp(log_deviation) * deg_per_rad; }

void keep_every_second(std::vector<double>& values) {
    const std::size_t kept = (values.size() + 1) / 2;
    for (std::size_t i = 0; i < kept; ++i) { values[i] = values[2 * i]; }
    values.resize(kept);
}

GapCurve allan_curve(const Observation& observation, std::size_t axis) {
    const Prediction& prediction = observation.prediction();
    const std::vector<float>& residual = observation.axis(axis).residual_rad_s;
    std::vector<double> integral(residual.size() + 1, 0.0);
    for (std::size_t i = 0; i < residual.size(); ++i) {
        integral[i + 1] = integral[i] + static_cast<double>(residual[i]);
    }
    GapCurve curve{&measures::allan, axis, axis, {}, {}};
    std::size_t stride = 1;
    for (std::size_t m = 1; 4 * m <= residual.size(); m *= 2) {
        // Eight places within one averaging time tell nearly as much as all.
        if (m / resolution::allan_places > stride) {
            stride = m / resolution::allan_places;
            keep_every_second(integral);
        }
        const auto within = static_cast<Eigen::Index>(m / stride);
        const Eigen::Map<const Eigen::ArrayXd> sums(integral.data(),
                                                    static_cast<Eigen::Index>(integral.size()));
        const Eigen::Index count = sums.size() - 2 * within;
        const double squares =
            (sums.tail(count) - 2.0 * sums.segment(within, count) + sums.head(count)).square().sum();
        const auto span = static_cast<double>(m);
        curve.x.push_back(span / prediction.rate_hz());
        curve.value.push_back(0.5 * std::log(squares / (2.0 * static_cast<double>(count) * span * span)));
    }
    return curve;
}

}  // namespace

const Measure measures::allan{.name = "Allan deviation",
                              .x_name = "averaging time (s)",
                              .y_name = "σ(τ) (deg/s)",
                              .shown_x = as_it_is,
                              .shown_y = deviation_dps,
                              .locate = locate_averaging_times,
                              .log_x = true,
                              .log_y = true,
                              .in_halves = false,
                              .is_of_noise = true};

void add_allan_curve(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    curves.push_back(allan_curve(observation, axis));
}

}  // namespace gyrolog
