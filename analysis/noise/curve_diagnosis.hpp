// Why the Allan curve of a model differs from a measured one of which only the numbers are known.
//
// Residuals are 20 log10(measured / model), with the likelihood of curve_scatter.hpp. The model's terms are
// free within their stated uncertainty, without one they are fixed. A change is a term of the model whose
// size becomes free, or a term that the model lacks. That change is made which lowers Schwarz's criterion
// most, as long as it falls by more than 10 ("very strong" by Kass and Raftery (1995), table 2), six changes
// at most. One is taken back without which the criterion rises by less than 2 (as in curve_model.hpp).
//
// The scatter of the record behind the curve is known by the smooth part of the residuals only. So gaps are
// measured in what the complete noise model, fitted to the measured curve, leaves over.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/noise/curve_gap.hpp"
#include "analysis/noise/curve_model.hpp"

namespace gyrolog {

struct ModelledTerm {
    CurveTerm term;
    double sd_rel = 0.0;     // of its size, as the model states it
    bool may_change = true;  // false: it is no cause, such as the noise of the converter's step
};

// Another change in place of one that was made.
struct CurveRival {
    CurveTerm term;
    double criterion_behind = 0.0;  // by how much its criterion is worse
};

struct CurveCause {
    CurveTerm term;  // as the curve has it; of the size 0 where the curve shows none of the model's
    double size_sd_rel = 0.0;
    double shape_sd_rel = 0.0;
    std::optional<CurveTerm> in_model;  // what it replaces; none: the model lacks the term
    double criterion_gain = 0.0;        // by which the criterion rises without it
    double probability = 0.0;           // against doing without it, and against every rival
    std::vector<CurveRival> rivals;     // within curve_tie_margin of it
    double from_tau_s = 0.0;            // where it makes at least half the change that it makes at most
    double to_tau_s = 0.0;
    double share = 0.0;  // of the gap's square, what returns without this change; shares may overlap

    // Of the size in the model; no meaning for a term that it lacks.
    double factor() const { return in_model ? term.size / in_model->size : 0.0; }
    // The model has it, or has more of it, than the curve.
    bool is_of_model() const { return in_model && term.size < in_model->size; }
};

// Averaging times at which the corrected model is off by more than curve_floors_closed.
struct CurveLeft {
    double from_tau_s = 0.0;
    double to_tau_s = 0.0;
    double floors = 0.0;  // root mean square over them
};

inline constexpr double curve_tie_margin = 8.0;  // 4 nats

struct CurveDiagnosis {
    // known: with the changes the gap is none, or less than a tenth of its square is left. partly: more is,
    // and one change at least that is right more likely than not has a share of a tenth or more.
    enum class Verdict { none, known, partly, unexplained };

    Verdict verdict = Verdict::none;
    std::size_t points = 0;
    CurveResidual before;
    CurveResidual after;
    double floor_db = 0.0;  // root mean square
    double shrink = 0.0;    // 1 - (after^2 - floor^2) / (before^2 - floor^2), root mean squares
    std::vector<CurveGapStretch> stretches;  // of the model as it is; without terms
    std::vector<CurveCause> causes;          // by falling criterion_gain
    std::vector<CurveTerm> corrected;
    std::vector<CurveLeft> left;  // of a gap that is not closed; the largest first

    double in_floors(const CurveResidual& residual) const { return residual.rms_db / floor_db; }
};

// A gap that is at most this many times the floor is none, or is closed.
inline constexpr double curve_floors_closed = 1.5;
// Of a gap's square: what is worth naming, and what may be left of a gap that is explained.
inline constexpr double curve_share_min = 0.1;
// A change of less probability does not make a verdict.
inline constexpr double curve_probability_min = 0.5;

// The curve has at least curve_fit_points_min points with a positive deviation, the model at least one term.
CurveDiagnosis diagnose_curve(const AllanCurve& curve, const std::vector<ModelledTerm>& model,
                              const CurveFitOptions& options = {});

}  // namespace gyrolog
