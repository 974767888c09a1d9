// A measured Allan curve against that of its simulation: where they part, and by which terms.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/curve_model.hpp"

namespace gyrolog {

// Averaging times over which the sensor lies to one side of the simulation by more than `curve_gap_floor_db`.
struct CurveGapStretch {
    double from_tau_s = 0.0;
    double to_tau_s = 0.0;
    double worst_db = 0.0;  // sensor over simulation; above 0 the sensor is the noisier
    double worst_tau_s = 0.0;
    // Of the terms in which the two fitted models differ: the one that makes most of the difference of their
    // variances at worst_tau_s, in the direction of the stretch, and its part of all that acts so.
    std::optional<CurveTerm::Kind> term;
    double share = 0.0;
};

struct CurveGapTerm {
    enum class Verdict { agrees, lacking, too_weak, too_strong, extra };  // what the simulation's term is
    CurveTerm::Kind kind = CurveTerm::Kind::N;
    std::optional<CurveTerm> sensor;
    std::optional<CurveTerm> simulation;
    Verdict verdict = Verdict::agrees;
};

std::string_view name_of(CurveGapTerm::Verdict verdict);

struct CurveGap {
    CurveResidual residual;  // 20 log10(sensor / simulation)
    std::size_t points = 0;  // averaging times at which both are known
    std::vector<CurveGapStretch> stretches;
    std::vector<CurveGapTerm> terms;
};

inline constexpr double curve_gap_floor_db = 0.35;  // two readings of 2 % differ by twice their sigma

// At the sensor's averaging times within the simulation's; between its points the simulation's curve is taken
// as straight on logarithmic axes. Nothing where they share no averaging time.
std::optional<CurveGap> compare_curves(const AllanCurve& sensor, const CurveModelFit& sensor_fit,
                                       const AllanCurve& simulation, const CurveModelFit& simulation_fit);

}  // namespace gyrolog
