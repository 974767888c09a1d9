// The trial grid is the parameter values that an effect's signature asks to be tried.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/simulate/effect_signature.hpp"

namespace gyrolog {

using ParamValues = std::map<std::string, double>;

struct TrialPoint {
    ParamValues params;
    std::size_t group = 0;
    std::vector<std::size_t> index;         // by parameter of the group
    std::span<const TrialValues> values{};  // that the group varies
    double peak = 0.0;                      // that values stay below
};

// The function returns all points of all groups, group by group, the last parameter running fastest: one
// point without parameters where the signature asks for none. Groups with values below a peak come once for
// each of `peaks`, which are in the parameter's unit.
std::vector<TrialPoint> trial_points(const EffectSignature& signature, std::span<const double> peaks = {});

// The function moves a value along its trial's scale, where a step of 1 is one of the trial values'.
double moved_value(const TrialValues& values, double peak, double value, double steps);
// How far such a step leads, about a value.
double step_at(const TrialValues& values, double peak, double value);

}  // namespace gyrolog
