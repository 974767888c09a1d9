// The terms of an Allan curve as parts of a sensor model: what its coefficients and its stationary effects
// give, and what a changed or missing term is called.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "analysis/noise/curve_diagnosis.hpp"
#include "analysis/simulate/sensor_model.hpp"

namespace gyrolog {

struct ModelledCurve {
    std::vector<ModelledTerm> terms;
    std::vector<std::string>
        not_in_curve;  // effects of the model that leave no term on a curve, or none here
};

// Q, N, B, K, R with their stated uncertainty, the converter's step as white noise, and the effects that are
// terms of a curve; these and the step are taken as they are.
ModelledCurve curve_of_model(const SensorModel& model, std::size_t axis);

// What a cause is called: the effect that adds it to a model, with the effect's parameters; a term that the
// model has too much of no effect can add, and it is NAME_excess with the factor it should have.
struct CurveEffect {
    std::string effect;
    std::map<std::string, double> params;
    std::map<std::string, double> sd;
};
CurveEffect effect_of(const CurveCause& cause);
// Of a term that would be new, or would be changed.
std::string effect_name(CurveTerm::Kind kind);

// The model with the cause's term as the curve has it.
void correct(SensorModel& model, std::size_t axis, const CurveCause& cause);

}  // namespace gyrolog
