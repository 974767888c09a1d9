#include "host/app/diagnosis_output.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/simulate/sensor_simulator.hpp"
#include "host/app/command.hpp"
#include "host/app/figure_file.hpp"
#include "host/formats/diagnosis_text.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t title_length_max = 80;

// Whoever writes such a name expects a simulator's file.
constexpr std::array<std::string_view, 9> simulator_endings = {
    ".sdf", ".world", ".urdf", ".xacro", ".gazebo", ".mjcf", ".xml", ".yaml", ".yml"};

// A terminal, a pipe or /dev/null has no ending to go by.
bool is_device(const std::string& path) {
    std::error_code none;
    const auto there = std::filesystem::status(path, none);
    return std::filesystem::exists(there) && !std::filesystem::is_regular_file(there) &&
           !std::filesystem::is_directory(there);
}

}  // namespace

Result<ModelSource> read_single_model(const std::string& path) {
    GYROLOG_TRY(ModelSource source, read_model_source(path, 1));
    const ModelFile& file = source.file;
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
    return source;
}

Result<CorrectedOutput> corrected_output(const std::string& path, const ModelSource* source) {
    const auto ends_in = [&](std::string_view ending) { return path.ends_with(ending); };
    if (source == nullptr || source->simulator == nullptr) {
        if (!std::ranges::any_of(simulator_endings, ends_in)) { return CorrectedOutput{path}; }
        return invalid_argument(
            fmt::format("--model-out '{}': the model is no simulator's file: write a .json, of "
                        "which `gyrolog export` makes one",
                        path));
    }
    const SimulatorFileKind& kind = source->simulator->kind(source->sensor);
    const std::string own = std::filesystem::path(source->file_path).extension().string();
    const bool is_own = std::ranges::any_of(kind.endings, ends_in) || (!own.empty() && ends_in(own));
    if (path.empty() || ends_in(".model.json") || (ends_in(".json") && !is_own)) {
        return CorrectedOutput{path};
    }
    if (is_own || is_device(path)) { return CorrectedOutput{path, source}; }
    return invalid_argument(
        fmt::format("--model-out '{}': the model is {}: write the same ({}), or gyrolog's own ({})", path,
                    kind.called, fmt::join(kind.endings, ", "),
                    std::ranges::count(kind.endings, ".json") > 0 ? ".model.json" : ".json"));
}

Result<std::string> corrected_text(const CorrectedOutput& output, const SensorModel& corrected,
                                   const std::string& against, double horizon_s,
                                   std::vector<std::string>& told) {
    if (output.changed == nullptr) { return format_model(corrected); }
    const std::string from = output.changed->name + " and its diagnosis against " + against;
    auto changed = changed_simulator_file(*output.changed, corrected, from,
                                          std::max(horizon_s, 1.0 / corrected.rate_hz));
    if (!changed.ok()) { return in_context("change '" + output.changed->name + "'", changed.error()); }
    for (const std::string& line : changed->told) { told.push_back(output.path + ": " + line); }
    told.emplace_back("--model-out NAME.model.json gets the whole model");
    return std::move(changed->text);
}

DiagnosisFigure titled_figure(const Diagnosis& diagnosis, std::string_view of,
                              std::vector<std::string> facts) {
    std::string title = verdict_sentence(diagnosis, of);
    if (title.size() > title_length_max) {
        facts.insert(facts.begin(), std::move(title));
        title = short_verdict_sentence(diagnosis, of);
    }
    return DiagnosisFigure{diagnosis, std::move(title), std::move(facts), {}};
}

Status write_diagnosis_plot(const Diagnosis& diagnosis, std::string_view of, std::vector<std::string> facts,
                            const PaperSize& paper, const std::string& path) {
    DiagnosisFigure figure = titled_figure(diagnosis, of, std::move(facts));
    figure.paper = paper;
    return write_figure(render(figure), path);
}

void tell_notices(Console& console, const std::vector<std::string>& notices) {
    for (const std::string& notice : notices) { console.err << "gyrolog diagnose: " << notice << '\n'; }
}

void tell_warnings(Console& console, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) { say_warning(console, "diagnose", warning); }
}

}  // namespace gyrolog
