#include "host/app/recording_diagnosis_run.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/diagnose/baseline.hpp"
#include "analysis/diagnose/diagnosis.hpp"
#include "analysis/diagnose/means_model.hpp"
#include "analysis/diagnose/swallowed_noise.hpp"
#include "host/app/command.hpp"
#include "host/app/diagnosis_output.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/quantity.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/result_output.hpp"
#include "host/formats/diagnosis_json.hpp"
#include "host/formats/diagnosis_text.hpp"
#include "host/formats/effect_words.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {
namespace {

Result<std::shared_ptr<const Recording>> diagnosable(const RecordingDiagnosisRequest& request,
                                                     const std::string& path) {
    RecordingInput input{path, std::nullopt, request.lsb_dps};
    input.samples_most = (diagnosable_samples_max + 1) * request.average;
    input.samples_per_row = request.average;
    GYROLOG_TRY(Recording recording, read_recording(input));
    if (const auto refusal = diagnosis_refusal(recording)) {
        return Error{ErrorCode::failed, request.average > 1
                                            ? fmt::format("diagnose '{}': in means of {} samples it {}", path,
                                                          request.average, *refusal)
                                            : "diagnose '" + path + "': " + *refusal};
    }
    if (recording.rows() > diagnosable_samples_max) {
        recording = first_rows(std::move(recording), diagnosable_samples_max);
        recording.warnings.push_back(fmt::format(
            "'{}' is looked at from its beginning to {}: a diagnosis takes no more than {} samples; "
            "`--average {}` looks at {} times as much for what is slow, in means of so many samples",
            path, format_duration(recording.duration_s()), diagnosable_samples_max, 10 * request.average,
            10));
    }
    return std::make_shared<const Recording>(std::move(recording));
}

// Of a model that is held against means.
std::vector<std::string> left_out(const SensorModel& of_samples, const SensorModel& of_means) {
    std::vector<std::string> warnings;
    for (const EffectModel& entry : of_samples.effects) {
        if (std::ranges::count(of_means.effects, entry.effect, &EffectModel::effect) != 0) { continue; }
        warnings.push_back(fmt::format(
            "the model's {} is left out: means of samples do not show it as samples do", entry.effect));
    }
    return warnings;
}

// What was found in means, in a model of samples.
SensorModel corrected(SensorModel model, const Diagnosis& diagnosis) {
    model = with_noise(std::move(model), diagnosis.swallowed);
    for (const Cause& cause : diagnosis.causes) { model = with_cause(std::move(model), cause.finding); }
    for (const std::size_t axis : diagnosis.axes) {
        model.axes[axis].bias_rad_s = diagnosis.corrected.axes[axis].bias_rad_s;
    }
    return model;
}

Result<Diagnosis> diagnosed(Console& console, const RecordingDiagnosisRequest& request) {
    GYROLOG_TRY(const ModelFile file, read_single_model(request.model_path));
    GYROLOG_TRY(const std::shared_ptr<const Recording> recording,
                diagnosable(request, request.recording_path));
    DiagnosisOptions options;
    options.seed = request.seed;
    options.simulations = request.simulations;
    options.threads = request.threads;
    if (!request.holdout_path.empty()) {
        GYROLOG_TRY(options.holdout, diagnosable(request, request.holdout_path));
    }
    options.on_progress = [&](const char* what, double share) {
        if (console.progress) {
            console.err << fmt::format("\r\x1b[K  {}  {:.0f} %", what, 100.0 * share) << std::flush;
        }
        return !console.stop_wanted();
    };
    const SensorModel model = model_of_means(file.model, request.average);
    auto diagnosis =
        diagnose(recording, model, std::filesystem::path(request.model_path).filename().string(), options);
    if (console.progress) { console.err << "\r\x1b[K" << std::flush; }
    if (!diagnosis) { return Error{ErrorCode::failed, "interrupted; nothing is written"}; }
    if (request.average > 1) { diagnosis->corrected = corrected(file.model, *diagnosis); }
    for (const std::vector<std::string>& more :
         {recording->warnings, file.notes, left_out(file.model, model)}) {
        diagnosis->warnings.insert(diagnosis->warnings.end(), more.begin(), more.end());
    }
    return *std::move(diagnosis);
}

std::vector<std::string> facts_of(const Diagnosis& diagnosis) {
    std::vector<std::string> facts{
        fmt::format("{} simulations, seed {}", diagnosis.simulations, diagnosis.seed),
        fmt::format("{:.6g} Hz, {}", diagnosis.rate_hz, format_duration(diagnosis.duration_s))};
    for (const Cause& cause : diagnosis.causes) {
        facts.push_back(
            fmt::format("{}: {}", axes_text(cause.finding.where.axes), effect_words(cause.finding)));
    }
    return facts;
}

Status write_results(Console& console, const RecordingDiagnosisRequest& request, const Diagnosis& diagnosis) {
    if (request.json_path != "-") {
        GYROLOG_CHECK(write_text(console, "-", diagnosis_text(diagnosis)));
    } else {
        tell_warnings(console, diagnosis.warnings);
    }
    if (!request.json_path.empty()) {
        GYROLOG_CHECK(write_text(console, request.json_path, diagnosis_json(diagnosis)));
    }
    if (!request.plot_path.empty()) {
        GYROLOG_CHECK(write_diagnosis_plot(diagnosis, verdict_sentence(diagnosis), facts_of(diagnosis),
                                           request.plot_path));
    }
    if (!request.model_out_path.empty()) {
        GYROLOG_CHECK(write_text(console, request.model_out_path, format_model(diagnosis.corrected)));
    }
    tell_written(console, {request.json_path, request.plot_path, request.model_out_path});
    return {};
}

}  // namespace

ExitCode diagnose_recording_to_files(Console& console, const RecordingDiagnosisRequest& request) {
    const auto fail = [&](const Error& error) { return report_error(console, "diagnose", error); };
    const NamedPath read[] = {{"RECORDING", request.recording_path},
                              {"--model", request.model_path},
                              {"--holdout", request.holdout_path}};
    const NamedPath written[] = {{"--json", request.json_path},
                                 {"--plot", request.plot_path},
                                 {"--model-out", request.model_out_path}};
    if (const Status fine = check_output_paths(read, written); !fine.ok()) { return fail(fine.error()); }
    const Result<Diagnosis> diagnosis = diagnosed(console, request);
    if (!diagnosis.ok()) { return fail(diagnosis.error()); }
    const Status done = write_results(console, request, *diagnosis);
    return done.ok() ? ExitCode::ok : fail(done.error());
}

}  // namespace gyrolog
