// The diagnosis of printed Allan curves against a model, for people and for programs.
//
// JSON: gyrolog-diagnosis/2 (diagnosis_json.hpp) without what only a recording has: p_none, p_left, the ends
// of intervals (lo and hi of gaps, shrink_lo, shrink_hi, share_lo, share_hi), and what tells of simulations.
// unnamed is empty, left has the averaging times at which the corrected model is off. In their place:
//   curve                    {name, reading_error}
//   curves                   by name: points, axis, floor_dB (root mean square of what the complete noise
//   model
//                            leaves over; gaps are in it), before, after {rms_dB, worst_dB, worst_tau_s} of
//                            measured over model, stretches [{from_tau_s, to_tau_s, worst_dB, worst_tau_s}],
//                            coefficients by name {model, curve, factor, unit}: those that are off
// A coefficient that is too large in the model has no effect that could be added: its cause is called
// flicker_excess, rrw_excess, ... with the parameter `factor`, by which the model's is to be multiplied.
#pragma once

#include <string>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/noise/curve_diagnosis.hpp"
#include "analysis/noise/curve_report.hpp"

namespace gyrolog {

struct DiagnosedCurve {
    std::string name;  // of the column
    std::size_t axis = 0;
    AllanCurve curve;
    std::vector<ModelledTerm> model;
    CurveDiagnosis diagnosis;
};

struct CurveDiagnosisReport {
    std::string curve_name;
    std::string model_name;
    RateUnit unit;
    CurveFitOptions options;
    std::vector<DiagnosedCurve> curves;
    std::vector<std::string> warnings;
};

// As a diagnosis of a recording has it: causes of one name on several axes are one; a domain for each curve,
// whose bands are the reading error.
Diagnosis as_diagnosis(const CurveDiagnosisReport& report);

std::string curve_diagnosis_json(const CurveDiagnosisReport& report);
std::string curve_diagnosis_text(const CurveDiagnosisReport& report);

}  // namespace gyrolog
