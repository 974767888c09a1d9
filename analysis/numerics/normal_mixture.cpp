#include "analysis/numerics/normal_mixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace gyrolog {

namespace {

// A narrower lattice is as good as normal: its error then takes less than 1e-5 off the kurtosis.
constexpr double narrow_lattice = 0.2;
constexpr double rest_min = 1e-4;

struct Weighted {
    double log_weight;
    double value;
};

// The variance of a normal that is a Student's t of variance 1 over all draws: (a - 1) / G, G of the gamma
// distribution with shape a = nu / 2. Trapezoids in ln G, where the integrand falls off at both ends.
std::vector<Weighted> student_variances(double nu) {
    if (std::isinf(nu)) { return {{0.0, 1.0}}; }
    const double a = 0.5 * nu;
    const double step = 0.35 / std::sqrt(a);
    constexpr double negligible_nats = 60.0;
    std::vector<Weighted> all;
    double sum = 0.0;
    const auto take = [&](double from_middle) {
        const double log_weight = -a * (std::expm1(from_middle) - from_middle);
        if (log_weight < -negligible_nats) { return false; }
        all.push_back({log_weight, (a - 1.0) / (a * std::exp(from_middle))});
        sum += std::exp(log_weight);
        return true;
    };
    for (int i = 0; take(step * i); ++i) {}
    for (int i = -1; take(step * i); --i) {}
    for (Weighted& each : all) { each.log_weight -= std::log(sum); }
    return all;
}

// A uniform distribution by Gauss and Legendre's three points: right up to its fifth moment.
std::array<Weighted, 3> uniform_points(double width) {
    const double out = 0.5 * width * std::sqrt(0.6);
    return {{{std::log(5.0 / 18.0), -out}, {std::log(8.0 / 18.0), 0.0}, {std::log(5.0 / 18.0), out}}};
}

constexpr double points_per_unit = 50.0;
constexpr double table_end = 10.7;  // asinh(2e4)

}  // namespace

NormalMixture::NormalMixture(double nu, double share, double lattice) {
    const bool wide = lattice > narrow_lattice;
    const double rest = std::max(rest_min, 1.0 - share - (wide ? lattice * lattice / 12.0 : 0.0));
    for (const Weighted& variance : student_variances(nu)) {
        const double sd = std::sqrt(share * variance.value + rest);
        if (!wide) {
            add(variance.log_weight, sd, 0.0);
            continue;
        }
        for (const Weighted& point : uniform_points(lattice)) {
            add(variance.log_weight + point.log_weight, sd, point.value);
        }
    }
}

void NormalMixture::add(double log_weight, double sd, double shift) {
    parts_.push_back({.weight = std::exp(log_weight),
                      .log_weight_over_sd = log_weight - std::log(sd),
                      .sd = sd,
                      .shift = shift});
}

double NormalMixture::log_density(double x) const {
    double most = -std::numeric_limits<double>::infinity();
    double sum = 0.0;
    for (const Part& part : parts_) {
        const double z = (x - part.shift) / part.sd;
        const double term = part.log_weight_over_sd - 0.5 * z * z;
        if (term <= most) {
            sum += std::exp(term - most);
        } else {
            sum = sum * std::exp(most - term) + 1.0;
            most = term;
        }
    }
    return most + std::log(sum) - 0.5 * std::log(2.0 * std::numbers::pi);
}

double NormalMixture::probability_below(double x) const {
    double sum = 0.0;
    for (const Part& part : parts_) {
        sum += part.weight * 0.5 * std::erfc((part.shift - x) / (part.sd * std::sqrt(2.0)));
    }
    return sum;
}

LogDensityTable::LogDensityTable(const NormalMixture& mixture) {
    // One point before zero and two behind the end, for the cubic.
    const auto count = static_cast<std::size_t>(table_end * points_per_unit) + 4;
    for (std::size_t i = 0; i < count; ++i) {
        values_.push_back(
            mixture.log_density(0.5 * std::sinh((static_cast<double>(i) - 1.0) / points_per_unit)));
    }
}

double LogDensityTable::operator()(double x) const {
    const double place =
        std::min(std::asinh(2.0 * std::fabs(x)) * points_per_unit, table_end * points_per_unit);
    const auto i = std::min(static_cast<std::size_t>(place), values_.size() - 4);
    const double u = place - static_cast<double>(i);
    const double before = values_[i];
    const double left = values_[i + 1];
    const double right = values_[i + 2];
    const double after = values_[i + 3];
    // The cubic through all four (Lagrange).
    return -u * (u - 1.0) * (u - 2.0) / 6.0 * before + (u * u - 1.0) * (u - 2.0) / 2.0 * left -
           u * (u + 1.0) * (u - 2.0) / 2.0 * right + u * (u * u - 1.0) / 6.0 * after;
}

}  // namespace gyrolog
