#include "host/app/diagnosis_output.hpp"

#include <utility>

#include <fmt/format.h>

#include "analysis/simulate/sensor_simulator.hpp"
#include "host/base/file_output.hpp"
#include "host/formats/diagnosis_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t title_length_max = 80;

}  // namespace

Result<ModelFile> read_single_model(const std::string& path) {
    GYROLOG_TRY(ModelFile file, read_model_file(path, 1));
    if (file.is_drawn) {
        return Error{
            ErrorCode::unsupported,
            fmt::format("'{0}': a data sheet is no single sensor; draw a unit with `gyrolog simulate {0} "
                        "-o unit.csv --model-out unit.json` and diagnose with that",
                        path)};
    }
    if (const auto refusal = simulation_refusal(file.model)) {
        return Error{ErrorCode::failed, "model '" + path + "': " + *refusal};
    }
    return file;
}

DiagnosisFigure titled_figure(const Diagnosis& diagnosis, std::string_view of,
                              std::vector<std::string> facts) {
    std::string title = verdict_sentence(diagnosis, of);
    if (title.size() > title_length_max) {
        facts.insert(facts.begin(), std::move(title));
        title = short_verdict_sentence(diagnosis, of);
    }
    return DiagnosisFigure{diagnosis, std::move(title), std::move(facts)};
}

Status write_diagnosis_plot(const Diagnosis& diagnosis, std::string_view of, std::vector<std::string> facts,
                            const std::string& path) {
    const Rendering rendering = render(titled_figure(diagnosis, of, std::move(facts)));
    if (!rendering.ok()) { return Error{ErrorCode::failed, "draw '" + path + "': " + rendering.problem}; }
    return write_file(path, rendering.png);
}

void tell_warnings(Console& console, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
        console.err << "gyrolog diagnose: warning: " << warning << '\n';
    }
}

}  // namespace gyrolog
