#include "analysis/diagnose/gap_measure.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/special_functions/gamma.hpp>

namespace gyrolog {

namespace {

// Where no simulation differs from another, rounding is no scale, and one sample further out than any of
// theirs is no wonder.
double least_sd(GapDomainKind kind) {
    switch (kind) {
        case GapDomainKind::amplitude:
            return 0.5;
        case GapDomainKind::repeats:
            return 1.0;
        default:
            return 1e-6;
    }
}

double sum_of_squares(const std::vector<double>& z) {
    double sum = 0.0;
    for (const double value : z) { sum += value * value; }
    return sum;
}

std::vector<double> standardised(const GapCurve& curve, const GapReference& reference, std::size_t index) {
    std::vector<double> z;
    for (std::size_t i = 0; i < curve.value.size(); ++i) {
        const double sd = reference.sd[index][i];
        z.push_back(sd > 0.0 ? (curve.value[i] - reference.mean[index][i]) / sd : 0.0);
    }
    return z;
}

// -ln of the upper tail of a gamma distribution with this mean and variance.
double gamma_surprise(double value, double mean, double variance) {
    if (!(variance > 0.0) || value <= mean) { return 0.0; }
    const double shape = mean * mean / variance;
    const double x = value * mean / variance;
    const double tail = boost::math::gamma_q(shape, x);
    if (tail > 1e-290) { return -std::log(tail); }
    // Leading term of the tail's expansion (DLMF 8.11.2).
    return x - (shape - 1.0) * std::log(x) + std::lgamma(shape);
}

}  // namespace

GapReference gap_reference(const SimulatedCurves& simulations, std::optional<std::size_t> left_out) {
    std::vector<const std::vector<GapCurve>*> used;
    for (std::size_t i = 0; i < simulations.size(); ++i) {
        if (i != left_out) { used.push_back(&simulations[i]); }
    }
    const auto count = static_cast<double>(used.size());
    GapReference reference;
    reference.degrees_of_freedom = count - 1.0;
    for (std::size_t c = 0; c < used.front()->size(); ++c) {
        const GapCurve& first = (*used.front())[c];
        const std::size_t points = first.value.size();
        std::vector<double> mean(points, 0.0);
        std::vector<double> sd(points, 0.0);
        for (std::size_t i = 0; i < points; ++i) {
            for (const auto* simulation : used) { mean[i] += (*simulation)[c].value[i] / count; }
            for (const auto* simulation : used) {
                const double off = (*simulation)[c].value[i] - mean[i];
                sd[i] += off * off / (count - 1.0);
            }
            sd[i] = std::max(std::sqrt(sd[i]), least_sd(first.kind));
        }
        reference.mean.push_back(std::move(mean));
        reference.sd.push_back(std::move(sd));
        double sum = 0.0;
        double squares = 0.0;
        for (const auto* simulation : used) {
            const double total = sum_of_squares(standardised((*simulation)[c], reference, c));
            sum += total;
            squares += total * total;
        }
        const double average = sum / count;
        reference.square_mean.push_back(average);
        reference.square_variance.push_back(std::max(squares / count - average * average, 0.0));
        reference.rms_scale.push_back(
            std::sqrt(average / static_cast<double>(std::max<std::size_t>(points, 1))));
    }
    return reference;
}

CurveDistance gap_of(const GapCurve& curve, const GapReference& reference, std::size_t index) {
    CurveDistance gap;
    gap.z = standardised(curve, reference, index);
    const double squares = sum_of_squares(gap.z);
    const auto points = static_cast<double>(std::max<std::size_t>(gap.z.size(), 1));
    const double scale = reference.rms_scale[index];
    gap.distance = scale > 0.0 ? std::sqrt(squares / points) / scale : 0.0;
    double worst = 0.0;
    for (const double z : gap.z) { worst = std::max(worst, std::fabs(z)); }
    // The simulations' mean and sd are themselves uncertain: Student's tail, not the normal one.
    const double degrees = reference.degrees_of_freedom;
    const double at_one_point =
        std::max(0.0, 0.5 * (degrees + 1.0) * std::log1p(worst * worst / degrees) - std::log(points));
    gap.surprise_nats = std::max(at_one_point, gamma_surprise(squares, reference.square_mean[index],
                                                              reference.square_variance[index]));
    return gap;
}

double worst_surprise_nats(const std::vector<GapCurve>& curves, const GapReference& reference) {
    double worst = 0.0;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        worst = std::max(worst, gap_of(curves[c], reference, c).surprise_nats);
    }
    return worst;
}

std::vector<double> simulated_surprises_nats(const SimulatedCurves& simulations) {
    std::vector<double> surprises;
    surprises.reserve(simulations.size());
    for (std::size_t i = 0; i < simulations.size(); ++i) {
        surprises.push_back(worst_surprise_nats(simulations[i], gap_reference(simulations, i)));
    }
    return surprises;
}

}  // namespace gyrolog
