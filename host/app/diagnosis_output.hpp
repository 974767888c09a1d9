// What both ways to diagnose read and write alike.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/plot/diagnosis_figure.hpp"
#include "host/app/console.hpp"
#include "host/base/result.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {

// A model that is one sensor. Errors: `unsupported` for a data sheet, `failed` with the reason where it
// cannot be simulated, and those of read_model_file().
Result<ModelFile> read_single_model(const std::string& path);

// The verdict is the title; one that is too long for the picture is the first fact, and the title has the
// number of causes. `of`: what was diagnosed.
DiagnosisFigure titled_figure(const Diagnosis& diagnosis, std::string_view of,
                              std::vector<std::string> facts);
Status write_diagnosis_plot(const Diagnosis& diagnosis, std::string_view of, std::vector<std::string> facts,
                            const std::string& path);

void tell_warnings(Console& console, const std::vector<std::string>& warnings);

}  // namespace gyrolog
