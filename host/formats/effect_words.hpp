// What a finding says, in words and units that people use.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/simulate/effect.hpp"

namespace gyrolog {

// A parameter's value with its standard deviation, where it has one, in a unit that the end of the name tells
// and the size chooses: "tau_s" 410 as "6.8 ± 1.0 min", "c1_dps_per_C" as deg/s or deg/h per degC. Shares
// become per cent; so do relative errors, `param` saying by its plausible range that it is one, or ppm.
std::string quantity_text(std::string_view name, double value, double sd, const EffectParam* param);

// A parameter as a model has it, under its name and in the unit that the name ends in: "phase_rad 2.484 ±
// 0.073 rad". What stands there can be written into a model.
std::string param_text(std::string_view name, double value, double sd);

// `words` with the finding's values in place of {param}; where axes differ in a value, all of them, each with
// its axis.
std::string filled_words(std::string_view words, const Finding& finding);

// The words of the effect's signature so filled; the effect's name where it has none.
std::string effect_words(const Finding& finding);

// These, or of what the model has too much: "The model has a line at 31 Hz that the recording lacks".
std::string cause_words(const Cause& cause);

// How large a cause is on axes that have the same of it: the values that its words name, one by one, each
// with its uncertainty where any of them has one. A value without a unit has its parameter's name before it.
struct CauseSize {
    std::string axes;  // "x, y"
    std::vector<std::string> values;
};
std::vector<CauseSize> cause_sizes(const Cause& cause);
// For a line without room: its sizes to three digits.
Cause without_uncertainty(Cause cause);

// "x", "x and y", "x, y and z"; `axes` by number.
std::string axes_text(const std::vector<std::size_t>& axes);

}  // namespace gyrolog
