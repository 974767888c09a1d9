// What both ways to diagnose read and write alike.
#pragma once

#include <string>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "host/app/console.hpp"
#include "host/base/result.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {

// A model that is one sensor. Errors: `unsupported` for a data sheet, `failed` with the reason where it
// cannot be simulated, and those of read_model_file().
Result<ModelFile> read_single_model(const std::string& path);

// A title that is too long for the picture gives way to the number of causes.
Status write_diagnosis_plot(const Diagnosis& diagnosis, std::string title, std::vector<std::string> facts,
                            const std::string& path);

void tell_warnings(Console& console, const std::vector<std::string>& warnings);

}  // namespace gyrolog
