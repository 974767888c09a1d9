#include "analysis/diagnose/measures/cross_axis.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "analysis/diagnose/measures/curve_place.hpp"
#include "analysis/diagnose/measures/frequency_bands.hpp"
#include "analysis/diagnose/measures/shown_values.hpp"

namespace gyrolog {

namespace {

Eigen::Map<const Eigen::ArrayXf> cosines(const AxisObservation& seen) {
    return {seen.cosines.data(), static_cast<Eigen::Index>(seen.cosines.size())};
}

// Of the coefficients of one band that the half has.
struct Products {
    double squares_a = 0.0;
    double squares_b = 0.0;
    double product = 0.0;
    double count = 0.0;
};

Products products_of(const AxisObservation& a, const AxisObservation& b, const SpectralBins& bins,
                     std::size_t first_bin, std::size_t end_bin) {
    Products sum;
    if (bins[first_bin].half == Half::both) {
        const auto first = static_cast<Eigen::Index>(bins[first_bin].first);
        const auto size = static_cast<Eigen::Index>(bins[end_bin - 1].end) - first;
        const auto of_a = cosines(a).segment(first, size);
        const auto of_b = cosines(b).segment(first, size);
        return {static_cast<double>(of_a.square().sum()), static_cast<double>(of_b.square().sum()),
                static_cast<double>((of_a * of_b).sum()), static_cast<double>(size)};
    }
    for (std::size_t i = first_bin; i < end_bin; ++i) {
        for (std::size_t k = bins[i].first; k < bins[i].end; ++k) {
            if (!bins[i].has(k)) { continue; }
            const auto of_a = static_cast<double>(a.cosines[k]);
            const auto of_b = static_cast<double>(b.cosines[k]);
            sum.squares_a += of_a * of_a;
            sum.squares_b += of_b * of_b;
            sum.product += of_a * of_b;
            sum.count += 1.0;
        }
    }
    return sum;
}

GapCurve correlation_curve(const Observation& observation, std::size_t axis, std::size_t other) {
    const SpectralBins& bins = observation.prediction().bins();
    const AxisObservation& a = observation.axis(axis);
    const AxisObservation& b = observation.axis(other);
    const std::vector<std::size_t> edges = band_edges(bins);
    GapCurve curve{&measures::cross_axis, axis, other, {}, {}};
    for (std::size_t band = 0; band + 1 < edges.size(); ++band) {
        const Products sum = products_of(a, b, bins, edges[band], edges[band + 1]);
        if (sum.count < 8.0) { continue; }
        curve.x.push_back(middle_hz(bins, edges[band], edges[band + 1]));
        curve.value.push_back(sum.product / std::sqrt(std::max(sum.squares_a * sum.squares_b, 1e-300)) *
                              std::sqrt(sum.count));
    }
    return curve;
}

void locate_correlation(const GapCurve& curve, const std::vector<double>& z, Place& where) {
    where.structure = "cross_axis";
    where.freq_hz = span_outside(curve, z);
}

}  // namespace

const Measure measures::cross_axis{.name = "correlation with ",
                                   .x_name = "frequency (Hz)",
                                   .y_name = "correlation (its sd)",
                                   .shown_x = as_it_is,
                                   .shown_y = as_it_is,
                                   .locate = locate_correlation,
                                   .log_x = true,
                                   .names_other = true,
                                   .is_of_noise = true};

void add_cross_axis_curves(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    for (const std::size_t other : observation.prediction().axes()) {
        if (other > axis) { curves.push_back(correlation_curve(observation, axis, other)); }
    }
}

}  // namespace gyrolog
