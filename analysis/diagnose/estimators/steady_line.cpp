#include "analysis/diagnose/estimators/steady_line.hpp"

#include <cmath>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

LineShape::LineShape(std::size_t length, double place)
    : place_(place),
      half_step_(pi / (2.0 * static_cast<double>(length))),
      half_scale_(0.5 * std::sqrt(2.0 / static_cast<double>(length))),
      sine_of_end_(std::sin(pi * place)),
      cosine_of_end_(std::cos(pi * place)) {}

LineShape::Pair LineShape::at(std::size_t k) const {
    const double number = static_cast<double>(k);
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    const double sine = sign * sine_of_end_;
    const double versine = 1.0 - sign * cosine_of_end_;
    const double mirrored = 1.0 / (2.0 * std::sin(half_step_ * (place_ + number)));
    const double away = place_ - number;
    if (std::fabs(away) < 1e-6) {
        const double peak = 0.5 * pi / half_step_;  // n
        return {half_scale_ * (peak + sine * mirrored), half_scale_ * versine * mirrored};
    }
    const double direct = 1.0 / (2.0 * std::sin(half_step_ * away));
    return {half_scale_ * sine * (direct + mirrored), half_scale_ * versine * (direct + mirrored)};
}

LineFit fit_line(std::size_t length, double place, std::size_t first, std::span<const float> cosines,
                 std::span<const double> weights) {
    const LineShape shape(length, place);
    double cc = 0.0;
    double cs = 0.0;
    double ss = 0.0;
    double cy = 0.0;
    double sy = 0.0;
    for (std::size_t i = 0; i < cosines.size(); ++i) {
        const auto [c, s] = shape.at(first + i);
        const auto y = static_cast<double>(cosines[i]);
        cc += weights[i] * c * c;
        cs += weights[i] * c * s;
        ss += weights[i] * s * s;
        cy += weights[i] * c * y;
        sy += weights[i] * s * y;
    }
    LineFit fit;
    fit.line.place = place;
    const double determinant = cc * ss - cs * cs;
    if (!(determinant > 1e-6 * cc * ss)) { return fit; }
    fit.line.cosine = (ss * cy - cs * sy) / determinant;
    fit.line.sine = (cc * sy - cs * cy) / determinant;
    fit.gain_nats = 0.5 * (fit.line.cosine * cy + fit.line.sine * sy);
    return fit;
}

}  // namespace gyrolog
