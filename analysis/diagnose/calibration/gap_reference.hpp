// The gap reference is what simulations give for every number of every curve. It tells how far a recording's
// curves are off, and how rarely chance has it so.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/diagnose/measures/gap_curves.hpp"

namespace gyrolog {

struct GapReference {
    std::vector<std::vector<double>> mean;  // by curve, by point
    std::vector<std::vector<double>> sd;    // the measure's least_sd at least
    // The part of sd^2 by which the simulations' own variance falls short of it. A sum over points has this
    // part as well, as if the simulations scattered by sd.
    std::vector<std::vector<double>> missing;
    // By curve, by window over neighbouring points: the standard deviation of the sum of their z.
    std::vector<std::vector<double>> window_sd;
    std::vector<double> rms_scale;  // by curve: root mean square, over simulations, of their own rms z
    // By curve: mean and variance, over the simulations, of the sum of z^2.
    std::vector<double> square_mean, square_variance;
    double degrees_of_freedom = 0.0;  // of every sd
};

using SimulatedCurves = std::vector<std::vector<GapCurve>>;  // by simulation

// `simulations` are at least ten, all from one prediction. The one at `left_out`, if there is one, has no
// part in the reference.
GapReference gap_reference(const SimulatedCurves& simulations,
                           std::optional<std::size_t> left_out = std::nullopt);

struct CurveDistance {
    std::vector<double> z;
    double distance = 0.0;  // rms of z in units of a simulation's: 1 is the floor
    std::vector<double> window_z;
    double squares = 0.0;  // sum of z^2
    // -ln of the probability that a simulation's curve is as far off in sum, or at one point, or over some
    // neighbouring points together; the largest. A point is judged by Student's t, the sum by a gamma
    // distribution with the simulations' mean and variance.
    double surprise_nats = 0.0;
    double at_one_place_nats = 0.0;  // by Student's t alone
};

CurveDistance gap_of(const GapCurve& curve, const GapReference& reference, std::size_t index);

// By curve of one observation: its own surprise or, where no axis stands out by itself, that of all axes'
// curves of the measure together if that is larger.
std::vector<double> surprises_nats(const std::vector<GapCurve>& curves, const GapReference& reference);
// A curve with so much stands out: of all kinds of curve together one has it by chance no more often than
// `decisions.false_alarms_most` (Bonferroni).
double stands_out_nats(const std::vector<GapCurve>& curves);
// The largest of all surprises, of single curves and of axes together.
double worst_surprise_nats(const std::vector<GapCurve>& curves, const GapReference& reference);
// By measure that one observation has: the largest surprise of its curves, less ln of their number for the
// choice, or that of all axes' curves together if that is larger. Of a measure that is not normal far out,
// at one place.
std::vector<double> measure_surprises_nats(const std::vector<GapCurve>& curves,
                                           const GapReference& reference);
// The worst surprise of every simulation against all the others: a new recording is not in its own reference
// either.
std::vector<double> simulated_surprises_nats(const SimulatedCurves& simulations);

}  // namespace gyrolog
