#include "analysis/spectrum/gamma_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/numerics/symmetric_eigen.hpp"

namespace gyrolog {
namespace {

using std::numbers::pi;

// Up to this number the pieces' correlation is resolved; more are taken as equally many independent ones.
constexpr std::size_t resolved_pieces = 32;

// Of the transforms of a piece at neighbouring bins: 1, -2/3, 1/6 by their distance.
std::vector<double> eigenvalues_of_bins(std::size_t bins) {
    Matrix correlation(bins, bins);
    for (std::size_t i = 0; i < bins; ++i) {
        for (std::size_t j = i < 2 ? 0 : i - 2; j <= i; ++j) {
            const double power = bin_correlation[i - j];
            correlation(i, j) = correlation(j, i) = i - j == 1 ? -std::sqrt(power) : std::sqrt(power);
        }
    }
    return symmetric_eigenvalues(correlation);
}

// Neighbouring pieces correlate by 1/6 (half a taper with the other half): a tridiagonal matrix.
std::vector<GammaPart> parts_of_pieces(const AveragedPeriodogram& periodogram) {
    const auto pieces = static_cast<double>(periodogram.pieces);
    if (periodogram.pieces > resolved_pieces || periodogram.overlaps == 0) {
        const double shape = periodogram.degrees_of_freedom(1) / 2.0;
        return {{1.0 / shape, shape}};
    }
    std::vector<GammaPart> parts;
    for (std::size_t i = 1; i <= periodogram.pieces; ++i) {
        const double angle = pi * static_cast<double>(i) / (pieces + 1.0);
        parts.push_back({(1.0 + std::cos(angle) / 3.0) / pieces, 1.0});
    }
    return parts;
}

// Cumulant generating function of sum(parts) - ratio * R, and its derivatives.
struct Cumulants {
    double value = 0.0;
    double slope = 0.0;
    double curvature = 0.0;
};

Cumulants cumulants_at(double t, std::span<const GammaPart> parts, double reference_shape, double ratio) {
    Cumulants k;
    const auto add = [&](double scale, double shape) {
        const double rest = 1.0 - scale * t;
        k.value -= shape * std::log(rest);
        k.slope += shape * scale / rest;
        k.curvature += shape * scale * scale / (rest * rest);
    };
    for (const GammaPart& part : parts) { add(part.scale, part.shape); }
    add(-ratio / reference_shape, reference_shape);
    return k;
}

double log_normal_tail(double r) {
    if (r < 30.0) { return std::log(0.5 * std::erfc(r / std::sqrt(2.0))); }
    return -0.5 * r * r - std::log(r * std::sqrt(2.0 * pi));
}

}  // namespace

std::vector<GammaPart> mean_of_bins(const AveragedPeriodogram& periodogram, std::size_t bins) {
    std::vector<GammaPart> parts;
    const std::vector<GammaPart> pieces = parts_of_pieces(periodogram);
    for (const double eigenvalue : eigenvalues_of_bins(bins)) {
        const double share = eigenvalue / static_cast<double>(bins);
        if (share <= 0.0) { continue; }
        for (const GammaPart& piece : pieces) { parts.push_back({share * piece.scale, piece.shape}); }
    }
    return parts;
}

double log_tail_of_ratio(std::span<const GammaPart> parts, double reference_shape, double ratio) {
    double mean = 0.0;
    double largest = 0.0;
    for (const GammaPart& part : parts) {
        mean += part.scale * part.shape;
        largest = std::max(largest, part.scale);
    }
    // Closer to the mean the formula divides nothing by nothing, and no line is that weak.
    if (ratio <= 1.01 * mean) { return 0.0; }
    double below = 0.0;
    double above = 1.0 / largest;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (below + above);
        (cumulants_at(middle, parts, reference_shape, ratio).slope < 0.0 ? below : above) = middle;
    }
    const double t = below;
    const Cumulants k = cumulants_at(t, parts, reference_shape, ratio);
    const double r = std::sqrt(std::max(-2.0 * k.value, 0.0));
    const double u = t * std::sqrt(k.curvature);
    const double log_density = -0.5 * r * r - 0.5 * std::log(2.0 * pi);
    const double log_tail = log_normal_tail(r);
    // tail = normal tail + density (1 / u - 1 / r), both divided by the density to stay in range.
    const double scaled = std::exp(log_tail - log_density) + 1.0 / u - 1.0 / r;
    return std::min(0.0, log_density + std::log(std::max(scaled, 1e-300)));
}

}  // namespace gyrolog
