// The parameter values that an effect's signature asks to be tried.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/simulate/effect_signature.hpp"

namespace gyrolog {

using ParamValues = std::map<std::string, double>;

struct TrialPoint {
    ParamValues params;
    std::size_t group = 0;
    std::vector<std::size_t> index;  // by parameter of the group
};

// All points of all groups, group by group, the last parameter running fastest. One point without parameters
// where the signature asks for none.
std::vector<TrialPoint> trial_points(const EffectSignature& signature);

double trial_value(const TrialValues& values, std::size_t index);

}  // namespace gyrolog
