// An effect that a person describes, as JSON, schema gyrolog-effect/1:
//
//   {"schema": "gyrolog-effect/1", "name": "heater of the enclosure", "effect": "time_table", "axes": ["z"],
//    "table": {"t_s": [0, 600, 1200], "bias_dps": [0, 0.02, 0]}}
//
// `effect`, `params` and `table` are those of a model's effects. Of use without an effect of the catalogue
// are `biquad` (a transfer function's coefficients), `density_table` (a density by frequency), and
// `time_table`, `temperature_table`, `rate_table` (a course of the bias). Without `axes` it acts on all of
// them; without a `name` it is called by its effect.
#pragma once

#include <string>
#include <string_view>

#include "analysis/diagnose/report.hpp"
#include "host/base/result.hpp"

namespace gyrolog {

// `name` is what errors call the text: the file's path. Errors: `malformed` for what is no JSON, an unknown
// key, a wrong type, or an entry with an effect_refusal(), each naming the key; `unsupported` for another
// schema.
Result<DescribedEffect> parse_described_effect(std::string_view text, const std::string& name);

// Also `not_found`, `permission_denied`, `failed` as the file system has it.
Result<DescribedEffect> read_described_effect(const std::string& path);

}  // namespace gyrolog
