#include "analysis/diagnose/calibration/gap_reference.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "analysis/diagnose/decision_options.hpp"
#include "analysis/numerics/distributions.hpp"

namespace gyrolog {

namespace {

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

// Of each window over 2, 4 or 8 neighbours, half of it overlapping the next: what is off on a broad front is
// little at every point.
std::vector<double> window_sums(const std::vector<double>& z) {
    std::vector<double> sums;
    for (std::size_t width = 2; width <= 8 && 2 * width <= z.size(); width *= 2) {
        for (std::size_t from = 0; from + width <= z.size(); from += width / 2) {
            double sum = 0.0;
            for (std::size_t i = from; i < from + width; ++i) { sum += z[i]; }
            sums.push_back(sum);
        }
    }
    return sums;
}

// The square of a normal deviate nearly as rare as Student's: the simulations' mean and sd are themselves
// uncertain.
double normal_square(double z, double degrees) { return degrees * std::log1p(z * z / degrees); }

// -ln of the upper tail of a gamma distribution with this mean and variance.
double gamma_surprise(double value, double mean, double variance) {
    if (!(variance > 0.0) || value <= mean) { return 0.0; }
    const double shape = mean * mean / variance;
    const double x = value * mean / variance;
    const double tail = gamma_upper_tail(shape, x);
    if (tail > 1e-290) { return -std::log(tail); }
    // Leading term of the tail's expansion (DLMF 8.11.2).
    return x - (shape - 1.0) * std::log(x) + std::lgamma(shape);
}

}  // namespace

namespace {

using UsedSimulations = std::vector<const std::vector<GapCurve>*>;

void add_points(const UsedSimulations& used, std::size_t c, GapReference& reference) {
    const auto count = static_cast<double>(used.size());
    const GapCurve& first = (*used.front())[c];
    const std::size_t points = first.value.size();
    std::vector<double> mean(points, 0.0);
    std::vector<double> sd(points, 0.0);
    std::vector<double> missing(points, 0.0);
    for (std::size_t i = 0; i < points; ++i) {
        for (const auto* simulation : used) { mean[i] += (*simulation)[c].value[i] / count; }
        for (const auto* simulation : used) {
            const double off = (*simulation)[c].value[i] - mean[i];
            sd[i] += off * off / (count - 1.0);
        }
        const double least = first.measure->least_sd;
        missing[i] = std::max(0.0, 1.0 - sd[i] / (least * least));
        sd[i] = std::max(std::sqrt(sd[i]), least);
    }
    reference.mean.push_back(std::move(mean));
    reference.sd.push_back(std::move(sd));
    reference.missing.push_back(std::move(missing));
}

// To the mean and variance of the sum of squares each point adds what its variance is short of, as a normal
// variable's: z counts it as there.
void add_sums(const UsedSimulations& used, std::size_t c, GapReference& reference) {
    const auto count = static_cast<double>(used.size());
    double sum = 0.0;
    double squares = 0.0;
    std::vector<double> window_sd;
    for (const auto* simulation : used) {
        const std::vector<double> z = standardised((*simulation)[c], reference, c);
        const double total = sum_of_squares(z);
        sum += total;
        squares += total * total;
        const std::vector<double> windows = window_sums(z);
        window_sd.resize(windows.size(), 0.0);
        for (std::size_t i = 0; i < windows.size(); ++i) {
            window_sd[i] += windows[i] * windows[i] / (count - 1.0);
        }
    }
    for (double& sd : window_sd) { sd = std::max(std::sqrt(sd), 1.0); }
    double average = sum / count;
    double variance = std::max(squares / count - average * average, 0.0);
    for (const double part : reference.missing[c]) {
        average += part;
        variance += 2.0 * part * part;
    }
    const std::size_t points = reference.mean[c].size();
    reference.window_sd.push_back(std::move(window_sd));
    reference.square_mean.push_back(average);
    reference.square_variance.push_back(variance);
    reference.rms_scale.push_back(std::sqrt(average / static_cast<double>(std::max<std::size_t>(points, 1))));
}

// Of the axes' curves of one measure: at one point or window of all of them, or in all.
double surprise_of_axes(const std::vector<CurveDistance>& gaps, const std::vector<std::size_t>& same_measure,
                        const GapReference& reference) {
    const auto axes = static_cast<double>(same_measure.size());
    const auto worst_of = [&](auto member) {
        double worst = 0.0;
        for (std::size_t i = 0; i < (gaps[same_measure.front()].*member).size(); ++i) {
            double squares = 0.0;
            for (const std::size_t c : same_measure) {
                squares += normal_square((gaps[c].*member)[i], reference.degrees_of_freedom);
            }
            worst = std::max(worst, squares);
        }
        return worst;
    };
    const double worst = std::max(worst_of(&CurveDistance::z), worst_of(&CurveDistance::window_z));
    const auto places =
        static_cast<double>(gaps[same_measure.front()].z.size() + gaps[same_measure.front()].window_z.size());
    double squares = 0.0;
    double mean = 0.0;
    double variance = 0.0;
    for (const std::size_t c : same_measure) {
        squares += gaps[c].squares;
        mean += reference.square_mean[c];
        variance += reference.square_variance[c];
    }
    return std::max(gamma_surprise(worst, axes, 2.0 * axes) - std::log(places),
                    gamma_surprise(squares, mean, variance));
}

}  // namespace

GapReference gap_reference(const SimulatedCurves& simulations, std::optional<std::size_t> left_out) {
    UsedSimulations used;
    for (std::size_t i = 0; i < simulations.size(); ++i) {
        if (i != left_out) { used.push_back(&simulations[i]); }
    }
    GapReference reference;
    reference.degrees_of_freedom = static_cast<double>(used.size()) - 1.0;
    for (std::size_t c = 0; c < used.front()->size(); ++c) {
        add_points(used, c, reference);
        add_sums(used, c, reference);
    }
    return reference;
}

CurveDistance gap_of(const GapCurve& curve, const GapReference& reference, std::size_t index) {
    CurveDistance gap;
    gap.z = standardised(curve, reference, index);
    gap.window_z = window_sums(gap.z);
    for (std::size_t i = 0; i < gap.window_z.size(); ++i) {
        gap.window_z[i] /= reference.window_sd[index][i];
    }
    gap.squares = sum_of_squares(gap.z);
    const auto points = static_cast<double>(std::max<std::size_t>(gap.z.size(), 1));
    const double scale = reference.rms_scale[index];
    gap.distance = scale > 0.0 ? std::sqrt(gap.squares / points) / scale : 0.0;
    double worst = 0.0;
    for (const double z : gap.z) { worst = std::max(worst, std::fabs(z)); }
    for (const double z : gap.window_z) { worst = std::max(worst, std::fabs(z)); }
    // The simulations' mean and sd are themselves uncertain: Student's tail, not the normal one.
    const double degrees = reference.degrees_of_freedom;
    const auto places = static_cast<double>(gap.z.size() + gap.window_z.size());
    gap.at_one_place_nats =
        std::max(0.0, 0.5 * (degrees + 1.0) * std::log1p(worst * worst / degrees) - std::log(places));
    gap.surprise_nats =
        std::max(gap.at_one_place_nats,
                 gamma_surprise(gap.squares, reference.square_mean[index], reference.square_variance[index]));
    return gap;
}

namespace {

struct Surprises {
    std::vector<double> own_nats;                                // by curve
    std::vector<double> at_one_place_nats;                       // by curve
    std::map<const Measure*, std::vector<std::size_t>> of_axes;  // curves of one axis alone, by measure
    std::map<const Measure*, double> together_nats;              // where there are several
};

Surprises surprises_of(const std::vector<GapCurve>& curves, const GapReference& reference) {
    Surprises surprises;
    std::vector<CurveDistance> gaps;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        gaps.push_back(gap_of(curves[c], reference, c));
        surprises.own_nats.push_back(gaps.back().surprise_nats);
        surprises.at_one_place_nats.push_back(gaps.back().at_one_place_nats);
        if (curves[c].of_all_axes) { continue; }
        std::vector<std::size_t>& same = surprises.of_axes[curves[c].measure];
        const bool as_long = same.empty() || gaps[same.front()].z.size() == gaps[c].z.size();
        if (curves[c].axis == curves[c].other && as_long) { same.push_back(c); }
    }
    for (const auto& [measure, same] : surprises.of_axes) {
        if (same.size() > 1) { surprises.together_nats[measure] = surprise_of_axes(gaps, same, reference); }
    }
    return surprises;
}

}  // namespace

std::vector<double> surprises_nats(const std::vector<GapCurve>& curves, const GapReference& reference) {
    const Surprises all = surprises_of(curves, reference);
    const double standing_out_nats = stands_out_nats(curves);
    std::vector<double> surprises = all.own_nats;
    for (const auto& [measure, together_nats] : all.together_nats) {
        const std::vector<std::size_t>& same = all.of_axes.at(measure);
        const bool one_stands_out =
            std::ranges::any_of(same, [&](std::size_t c) { return all.own_nats[c] >= standing_out_nats; });
        if (one_stands_out) { continue; }
        for (const std::size_t c : same) { surprises[c] = std::max(surprises[c], together_nats); }
    }
    return surprises;
}

double stands_out_nats(const std::vector<GapCurve>& curves) {
    std::set<const Measure*> kinds;
    for (const GapCurve& curve : curves) { kinds.insert(curve.measure); }
    return std::log(static_cast<double>(kinds.size()) / decisions.false_alarms_most);
}

double worst_surprise_nats(const std::vector<GapCurve>& curves, const GapReference& reference) {
    const Surprises all = surprises_of(curves, reference);
    double worst = std::ranges::max(all.own_nats);
    for (const auto& [measure, together_nats] : all.together_nats) { worst = std::max(worst, together_nats); }
    return worst;
}

std::vector<double> measure_surprises_nats(const std::vector<GapCurve>& curves,
                                           const GapReference& reference) {
    const Surprises all = surprises_of(curves, reference);
    // In the curves' order, so that sums are the same in every run.
    std::vector<std::pair<const Measure*, std::vector<double>>> by_measure;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        auto same =
            std::ranges::find(by_measure, curves[c].measure, [](const auto& one) { return one.first; });
        if (same == by_measure.end()) { same = by_measure.insert(same, {curves[c].measure, {}}); }
        const bool is_normal = curves[c].measure->is_normal_far_out;
        same->second.push_back(is_normal ? all.own_nats[c] : all.at_one_place_nats[c]);
    }
    std::vector<double> surprises;
    for (const auto& [measure, of_curves] : by_measure) {
        const double choice_nats = std::log(static_cast<double>(of_curves.size()));
        const auto together = all.together_nats.find(measure);
        const bool has_together = measure->is_normal_far_out && together != all.together_nats.end();
        surprises.push_back(std::max(
            {std::ranges::max(of_curves) - choice_nats, 0.0, has_together ? together->second : 0.0}));
    }
    return surprises;
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
