#include "analysis/diagnose/measures/gap_curves.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "analysis/diagnose/measures/motion_curves.hpp"
#include "analysis/diagnose/measures/noise_level_curves.hpp"
#include "analysis/diagnose/measures/structure_curves.hpp"

namespace gyrolog {

namespace {

constexpr std::size_t allan_places = 8;
constexpr std::size_t course_blocks = 32;
constexpr double bands_per_octave = 3.0;
constexpr double sigmas[] = {0.5, 1.0, 2.0, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0};

double square(double value) { return value * value; }

// Bins of one band each: first bin of every band, and the end.
std::vector<std::size_t> band_edges(const SpectralBins& bins) {
    std::vector<std::size_t> edges;
    double next_hz = 0.0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        if (bins[i].f_hz < next_hz) { continue; }
        edges.push_back(i);
        next_hz = bins[i].f_hz * std::exp2(1.0 / bands_per_octave) * 0.999;
    }
    edges.push_back(bins.size());
    return edges;
}

GapCurve spectrum_curve(const Observation& observation, std::size_t axis) {
    const SpectralBins& bins = observation.prediction().bins();
    const AxisObservation& seen = observation.axis(axis);
    const std::vector<std::size_t> edges = band_edges(bins);
    GapCurve curve{GapDomainKind::spectrum, axis, axis, {}, {}};
    for (std::size_t band = 0; band + 1 < edges.size(); ++band) {
        double count = 0.0;
        double ratio = 0.0;
        for (std::size_t i = edges[band]; i < edges[band + 1]; ++i) {
            count += bins[i].count();
            ratio += bins[i].count() * seen.power[i] / seen.density[i];
        }
        curve.x.push_back(std::sqrt(bins[edges[band]].f_hz * bins[edges[band + 1] - 1].f_hz));
        // The cube root of a chi-square is nearly normal, the logarithm of one with one degree is not (E. B.
        // Wilson, M. M. Hilferty, PNAS 17 (1931) 684).
        curve.value.push_back(3.0 * (std::cbrt(ratio / count) - 1.0));
    }
    return curve;
}

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
    GapCurve curve{GapDomainKind::allan, axis, axis, {}, {}};
    std::size_t stride = 1;
    for (std::size_t m = 1; 4 * m <= residual.size(); m *= 2) {
        // Eight places within one averaging time tell nearly as much as all.
        if (m / allan_places > stride) {
            stride = m / allan_places;
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

void course_and_drift(const Observation& observation, std::size_t axis, std::vector<GapCurve>& curves) {
    const std::vector<float>& white = observation.axis(axis).whitened;
    GapCurve course{GapDomainKind::course, axis, axis, {}, {}};
    GapCurve drift{GapDomainKind::drift, axis, axis, {}, {}};
    for (std::size_t block = 0; block < course_blocks; ++block) {
        const std::size_t first = block * white.size() / course_blocks;
        const std::size_t end = (block + 1) * white.size() / course_blocks;
        double sum = 0.0;
        double squares = 0.0;
        double count = 0.0;
        for (std::size_t slot = first; slot < end; ++slot) {
            if (!observation.present()[slot]) { continue; }
            sum += static_cast<double>(white[slot]);
            squares += square(static_cast<double>(white[slot]));
            count += 1.0;
        }
        const double at_s = 0.5 * static_cast<double>(first + end) / observation.prediction().rate_hz();
        course.x.push_back(at_s);
        drift.x.push_back(at_s);
        course.value.push_back(count > 0.0 ? std::log(std::max(squares / count, 1e-12)) : 0.0);
        drift.value.push_back(count > 0.0 ? sum / std::sqrt(count) : 0.0);
    }
    curves.push_back(std::move(course));
    curves.push_back(std::move(drift));
}

GapCurve amplitude_curve(const Observation& observation, std::size_t axis) {
    GapCurve curve{GapDomainKind::amplitude, axis, axis, {std::begin(sigmas), std::end(sigmas)}, {}};
    std::vector<double> beyond(curve.x.size(), 0.0);
    double skewness = 0.0;
    double count = 0.0;
    const std::vector<float>& white = observation.axis(axis).whitened;
    // Counted one threshold after the other, with the samples near at hand: no branch depends on their
    // values.
    constexpr std::size_t piece = 1024;
    std::array<float, piece> values{};
    for (std::size_t first = 0; first < white.size(); first += piece) {
        std::size_t known = 0;
        for (std::size_t slot = first; slot < std::min(first + piece, white.size()); ++slot) {
            values[known] = white[slot];
            known += std::size_t{observation.present()[slot]};
        }
        double cubes = 0.0;
        for (std::size_t i = 0; i < known; ++i) {
            const auto value = static_cast<double>(values[i]);
            cubes += value * value * value;
        }
        skewness += cubes;
        for (std::size_t s = 0; s < beyond.size(); ++s) {
            const auto least = static_cast<float>(curve.x[s]);
            int more = 0;
            for (std::size_t i = 0; i < known; ++i) { more += std::fabs(values[i]) > least ? 1 : 0; }
            beyond[s] += static_cast<double>(more);
        }
        count += static_cast<double>(known);
    }
    for (const double number : beyond) { curve.value.push_back(2.0 * std::sqrt(number + 0.375)); }
    curve.x.push_back(0.0);
    curve.value.push_back(skewness / std::sqrt(15.0 * std::max(count, 1.0)));
    return curve;
}

Eigen::Map<const Eigen::ArrayXf> cosines(const AxisObservation& seen) {
    return {seen.cosines.data(), static_cast<Eigen::Index>(seen.cosines.size())};
}

GapCurve correlation_curve(const Observation& observation, std::size_t axis, std::size_t other) {
    const SpectralBins& bins = observation.prediction().bins();
    const AxisObservation& a = observation.axis(axis);
    const AxisObservation& b = observation.axis(other);
    const std::vector<std::size_t> edges = band_edges(bins);
    GapCurve curve{GapDomainKind::cross_axis, axis, other, {}, {}};
    for (std::size_t band = 0; band + 1 < edges.size(); ++band) {
        const auto first = static_cast<Eigen::Index>(bins[edges[band]].first);
        const auto size = static_cast<Eigen::Index>(bins[edges[band + 1] - 1].end) - first;
        const auto of_a = cosines(a).segment(first, size);
        const auto of_b = cosines(b).segment(first, size);
        const auto squares_a = static_cast<double>(of_a.square().sum());
        const auto squares_b = static_cast<double>(of_b.square().sum());
        const auto product = static_cast<double>((of_a * of_b).sum());
        const auto count = static_cast<double>(size);
        if (count < 8.0) { continue; }
        curve.x.push_back(std::sqrt(bins[edges[band]].f_hz * bins[edges[band + 1] - 1].f_hz));
        curve.value.push_back(product / std::sqrt(std::max(squares_a * squares_b, 1e-300)) *
                              std::sqrt(count));
    }
    return curve;
}

}  // namespace

std::vector<GapCurve> gap_curves(const Observation& observation) {
    const Prediction& prediction = observation.prediction();
    // Means of codes are equal now and then, those of a simulation never; and how samples are distributed
    // their means do not tell, but a spike among them is far from the others.
    const bool are_samples = prediction.world().recording().samples_per_row == 1;
    std::vector<GapCurve> curves;
    for (const std::size_t axis : prediction.axes()) {
        curves.push_back(allan_curve(observation, axis));
        curves.push_back(spectrum_curve(observation, axis));
        curves.push_back(narrow_curve(observation, axis, band_edges(prediction.bins())));
        course_and_drift(observation, axis, curves);
        if (are_samples) {
            curves.push_back(amplitude_curve(observation, axis));
            curves.push_back(repeats_curve(observation, axis));
        }
        curves.push_back(period_curve(observation, axis));
        curves.push_back(codes_curve(observation, axis));
        if (varies(prediction.temperature_C())) { curves.push_back(temperature_curve(observation, axis)); }
        for (const std::size_t other : prediction.axes()) {
            if (other > axis) { curves.push_back(correlation_curve(observation, axis, other)); }
        }
        if (prediction.moves()) {
            std::ranges::move(motion_curves(observation, axis), std::back_inserter(curves));
        }
    }
    std::ranges::move(noise_level_curves(observation), std::back_inserter(curves));
    return curves;
}

}  // namespace gyrolog
