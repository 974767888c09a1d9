// What both ways to diagnose read and write alike.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnose/report.hpp"
#include "analysis/plot/diagnosis_figure.hpp"
#include "host/app/console.hpp"
#include "host/base/result.hpp"
#include "host/formats/model_source.hpp"

namespace gyrolog {

// A model that is one sensor. Errors: `unsupported` for a data sheet, `failed` with the reason where it
// cannot be simulated, and those of read_model_source().
Result<ModelSource> read_single_model(const std::string& path);

// Where the corrected model goes (--model-out): a simulator's file is changed where the name ends as its kind
// does, and gyrolog-model/1 written where it ends in .json (.model.json where the kind itself ends so).
struct CorrectedOutput {
    std::string path;                      // empty: nowhere
    const ModelSource* changed = nullptr;  // null: gyrolog-model/1
};
// `source`: what --model was; null: nothing (--auto). Error `invalid_argument`: a name that ends as neither.
Result<CorrectedOutput> corrected_output(const std::string& path, const ModelSource* source);

// The text, with what is to be told of it added to `told`.
Result<std::string> corrected_text(const CorrectedOutput& output, const SensorModel& corrected,
                                   const std::string& against, double horizon_s,
                                   std::vector<std::string>& told);

// The verdict is the title; one that is too long for the picture is the first fact, and the title has the
// number of causes. `of`: what was diagnosed.
DiagnosisFigure titled_figure(const Diagnosis& diagnosis, std::string_view of,
                              std::vector<std::string> facts);
Status write_diagnosis_plot(const Diagnosis& diagnosis, std::string_view of, std::vector<std::string> facts,
                            const PaperSize& paper, const std::string& path);

void tell_notices(Console& console, const std::vector<std::string>& notices);
void tell_warnings(Console& console, const std::vector<std::string>& warnings);

}  // namespace gyrolog
