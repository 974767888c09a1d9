#include "host/app/curve_diagnosis_run.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host/app/command.hpp"
#include "host/app/diagnosis_output.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/base/file_output.hpp"
#include "host/formats/curve_csv.hpp"
#include "host/formats/curve_diagnosis_report.hpp"
#include "host/formats/curve_effect.hpp"

namespace gyrolog {
namespace {

bool is_simulation(const PrintedCurve& curve) { return curve.name.starts_with("sim"); }

std::optional<std::size_t> axis_of(const std::string& name) {
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        if (name == axis_names[axis] || name.ends_with(std::string("_") + axis_names[axis])) { return axis; }
    }
    return std::nullopt;
}

// What follows "sensor" or "simulation": "_x".
std::string_view suffix_of(const PrintedCurve& curve) {
    const std::string_view name = curve.name;
    return name.substr(std::min(name.find('_'), name.size()));
}

std::string names_of(const std::vector<std::string>& names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

class CurvesAgainst {
public:
    explicit CurvesAgainst(PrintedCurves curves) : curves_(std::move(curves)) {
        report_.curve_name = curves_.name;
        report_.unit = curves_.unit;
        report_.warnings = curves_.warnings;
    }

    Status model(const SensorModel& model) {
        for (const PrintedCurve& curve : curves_.curves) {
            if (is_simulation(curve)) { continue; }
            const auto axis = axis_of(curve.name);
            if (!axis) {
                report_.warnings.push_back(
                    fmt::format("the curve {} is left out: its name tells no axis (x, y, z, or NAME_x, ...)",
                                curve.name));
                continue;
            }
            ModelledCurve modelled = curve_of_model(model, *axis);
            if (!modelled.not_in_curve.empty()) {
                report_.warnings.push_back(
                    fmt::format("{}: without the model's {}, which a curve does not show", curve.name,
                                names_of(modelled.not_in_curve)));
            }
            if (modelled.terms.empty()) {
                return Error{
                    ErrorCode::failed,
                    fmt::format("the model's {} axis has no noise: there is no curve to compare with",
                                axis_names[*axis])};
            }
            add(curve, *axis, std::move(modelled.terms));
        }
        if (!report_.curves.empty()) { return {}; }
        return Error{ErrorCode::failed,
                     "no curve is of an axis: name the columns x_UNIT, sensor_x_UNIT, ..."};
    }

    Status own_simulation() {
        for (const PrintedCurve& curve : curves_.curves) {
            if (is_simulation(curve)) { continue; }
            const auto simulation = std::ranges::find_if(curves_.curves, [&](const PrintedCurve& other) {
                return is_simulation(other) && suffix_of(other) == suffix_of(curve);
            });
            if (simulation == curves_.curves.end()) { continue; }
            std::vector<ModelledTerm> terms;
            for (const CurveTerm& term : fit_curve_model(simulation->curve, report_.options).terms) {
                terms.push_back({term, 0.0, true});
            }
            report_.model_name = "its " + simulation->name;
            add(curve, axis_of(curve.name).value_or(0), std::move(terms));
        }
        if (!report_.curves.empty()) { return {}; }
        return Error{
            ErrorCode::invalid_argument,
            "give the --model, or a file with curves of the sensor and of its simulation (sensor_x_UNIT, "
            "simulation_x_UNIT)"};
    }

    CurveDiagnosisReport take_report() { return std::move(report_); }
    void name_model(std::string name) { report_.model_name = std::move(name); }

private:
    void add(const PrintedCurve& curve, std::size_t axis, std::vector<ModelledTerm> terms) {
        CurveDiagnosis diagnosis = diagnose_curve(curve.curve, terms, report_.options);
        report_.curves.push_back({curve.name, axis, curve.curve, std::move(terms), std::move(diagnosis)});
    }

    PrintedCurves curves_;
    CurveDiagnosisReport report_;
};

struct Outcome {
    CurveDiagnosisReport report;
    std::optional<ModelSource> source;
    std::optional<SensorModel> corrected;
};

Result<Outcome> diagnose(const CurveDiagnosisRequest& request) {
    GYROLOG_TRY(PrintedCurves curves, read_curve_csv(request.curve_path));
    if (curves.unit.sensor != SensorKind::gyro) {
        return Error{ErrorCode::unsupported,
                     "'" + request.curve_path + "' has curves of an accelerometer; a diagnosis is of a gyro"};
    }
    CurvesAgainst against(std::move(curves));
    if (request.model_path.empty()) {
        GYROLOG_CHECK(against.own_simulation());
        return Outcome{against.take_report(), std::nullopt, std::nullopt};
    }
    GYROLOG_TRY(ModelSource source, read_single_model(request.model_path));
    GYROLOG_CHECK(corrected_output(request.model_out_path, &source));
    const ModelFile& file = source.file;
    if (file.unstated.rate) {
        return Error{ErrorCode::malformed,
                     "model '" + request.model_path + "': rate_hz is missing, and a curve does not tell it"};
    }
    against.name_model(source.name);
    GYROLOG_CHECK(against.model(file.model));
    Outcome outcome{against.take_report(), std::move(source), std::nullopt};
    outcome.corrected = outcome.source->file.model;
    if (outcome.source->simulator != nullptr) {
        const std::vector<std::string>& notes = outcome.source->file.notes;
        outcome.report.warnings.insert(outcome.report.warnings.end(), notes.begin(), notes.end());
    }
    for (const DiagnosedCurve& curve : outcome.report.curves) {
        for (const CurveCause& cause : curve.diagnosis.causes) {
            correct(*outcome.corrected, curve.axis, cause);
        }
    }
    return outcome;
}

Status write_results(Console& console, const CurveDiagnosisRequest& request, const Outcome& outcome) {
    const CurveDiagnosisReport& report = outcome.report;
    ResultOutput results(console);
    if (request.json_path != "-") { results.show_verdict(curve_diagnosis_text(report)); }
    results.text(request.json_path, [&] { return curve_diagnosis_json(report); });
    results.file(request.plot_path, [&] {
        const Diagnosis diagnosis = as_diagnosis(report);
        std::vector<std::string> facts{
            fmt::format("bands: reading error of {:.3g} %, 95 %", 100.0 * report.options.reading_error)};
        return write_diagnosis_plot(diagnosis, "curve", std::move(facts), request.paper, request.plot_path);
    });
    std::vector<std::string> told;
    results.file(request.model_out_path, [&]() -> Status {
        GYROLOG_TRY(const CorrectedOutput output, corrected_output(request.model_out_path, &*outcome.source));
        GYROLOG_TRY(const std::string text,
                    corrected_text(output, *outcome.corrected,
                                   std::filesystem::path(request.curve_path).filename().string(),
                                   request.horizon_s, told));
        return write_file(request.model_out_path, as_bytes(text));
    });
    Status done = results.finish();
    tell_notices(console, told);
    return done;
}

Status check(const CurveDiagnosisRequest& request) {
    if (request.model_path.empty() && !request.model_out_path.empty()) {
        return Error{ErrorCode::invalid_argument, "--model-out corrects a model: give it with --model"};
    }
    const NamedPath read[] = {{"--curve", request.curve_path}, {"--model", request.model_path}};
    const NamedPath written[] = {{"--json", request.json_path},
                                 {"--plot", request.plot_path},
                                 {"--model-out", request.model_out_path}};
    return check_output_paths(read, written);
}

}  // namespace

ExitCode diagnose_curve_to_files(Console& console, const CurveDiagnosisRequest& request) {
    const auto fail = [&](const Error& error) { return report_error(console, "diagnose", error); };
    if (const Status fine = check(request); !fine.ok()) { return fail(fine.error()); }
    const Result<Outcome> outcome = diagnose(request);
    if (!outcome.ok()) { return fail(outcome.error()); }
    if (request.json_path == "-") { tell_warnings(console, outcome->report.warnings); }
    const Status written = write_results(console, request, *outcome);
    return written.ok() ? ExitCode::ok : fail(written.error());
}

}  // namespace gyrolog
