#include "analysis/diagnose/estimators/step_scan.hpp"

#include <cmath>

#include "analysis/noise/noise_model.hpp"

namespace gyrolog {

namespace {

// The coefficient is -scale sin(pi k m/n).
double scale_of(std::size_t length, std::size_t k) {
    const auto n = static_cast<double>(length);
    return std::sqrt(2.0 / n) / (2.0 * std::sin(pi * static_cast<double>(k) / (2.0 * n)));
}

}  // namespace

double step_coefficient(std::size_t length, double at, std::size_t k) {
    return -scale_of(length, k) * std::sin(pi * static_cast<double>(k) * at / static_cast<double>(length));
}

StepScan::StepScan(std::size_t length, std::size_t used)
    : length_(length), used_(used), transform_(2 * used) {}

double StepScan::spacing() const { return static_cast<double>(length_) / static_cast<double>(places()); }

double StepScan::sample_at(std::size_t place) const { return (static_cast<double>(place) + 0.5) * spacing(); }

StepScan::Fit StepScan::fit(std::span<const float> cosines, std::span<const double> weights) {
    const std::size_t count = places();
    // With x_j = pi (j + 1/2)/M: sin(k x_j) = (-1)^j cos((M - k) x_j), and sin^2 = (1 - cos(2 k x_j)) / 2.
    Fit fit;
    fit.pull.assign(count, 0.0);
    fit.information.assign(count, 0.0);
    double sum = 0.0;
    for (std::size_t k = 1; k <= used_; ++k) {
        const double scale = scale_of(length_, k);
        const double weighted = scale * weights[k - 1];
        fit.pull[count - k] = -weighted * static_cast<double>(cosines[k]);
        if (2 * k < count) { fit.information[2 * k] = -0.5 * scale * weighted; }
        sum += 0.5 * scale * weighted;
    }
    transform_.inverse(fit.pull);
    transform_.inverse(fit.information);
    // The transform is orthonormal, the sums are plain.
    const double norm = std::sqrt(0.5 * static_cast<double>(count));
    for (std::size_t j = 0; j < count; ++j) {
        fit.pull[j] *= j % 2 == 0 ? norm : -norm;
        fit.information[j] = sum + norm * fit.information[j];
    }
    return fit;
}

}  // namespace gyrolog
