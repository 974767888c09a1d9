#include "host/app/recording_diagnosis_run.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/diagnose/accelerometer_diagnosis.hpp"
#include "analysis/diagnose/diagnosis.hpp"
#include "analysis/diagnose/likelihood/corrected_model.hpp"
#include "analysis/diagnose/multiscale/long_diagnosis.hpp"
#include "analysis/diagnose/multiscale/means_model.hpp"
#include "analysis/diagnose/multiscale/motion_diagnosis.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"
#include "analysis/simulate/plain_model.hpp"
#include "host/app/command.hpp"
#include "host/app/diagnosis_input.hpp"
#include "host/app/diagnosis_output.hpp"
#include "host/app/figure_file.hpp"
#include "host/app/motion_refusal.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/progress_line.hpp"
#include "host/app/quantity.hpp"
#include "host/app/result_output.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/base/file_output.hpp"
#include "host/formats/described_effect_json.hpp"
#include "host/formats/diagnosis_json.hpp"
#include "host/formats/diagnosis_text.hpp"
#include "host/formats/effect_words.hpp"

namespace gyrolog {
namespace {

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

void append_warnings(std::vector<std::string>& to, const DiagnosisInput& of) {
    for (const auto& recording : {of.means, of.samples}) {
        if (recording != nullptr) { append_new(to, recording->warnings); }
    }
}

// In means that were asked for.
std::optional<Diagnosis> diagnose_means(const DiagnosisInput& read, const SensorModel& model,
                                        const std::string& name, const DiagnosisOptions& options) {
    const std::size_t samples = read.samples->samples_per_row;
    const double rate_hz = read.samples->rate_hz * static_cast<double>(samples);
    const SensorModel of_means = model_of_means(model, samples, rate_hz);
    std::optional<Diagnosis> diagnosis = diagnose_in_motion(read.samples, of_means, name, options);
    if (!diagnosis) { return std::nullopt; }
    for (Cause& cause : diagnosis->causes) {
        cause.finding = finding_of_samples(std::move(cause.finding), samples, rate_hz);
    }
    diagnosis->corrected = corrected_model(model, *diagnosis, diagnosis->corrected);
    append_new(diagnosis->warnings, left_out(model, of_means));
    return diagnosis;
}

DiagnosisOptions options_of(ProgressLine& progress, const RecordingDiagnosisRequest& request) {
    DiagnosisOptions options;
    options.seed = request.seed;
    options.simulations = request.simulations;
    options.threads = request.threads;
    options.on_progress = [&progress](const char* what, double share) {
        progress.show(what, share);
        return true;
    };
    return options;
}

// Of the recording's own: what a simulator has that knows of white noise and a bias only.
Result<ModelFile> read_plain_model(const Recording& recording, SensorKind sensor, const std::string& path) {
    const SensorUnit unit = sensor == SensorKind::gyro ? SensorUnit::dps() : unit_of_accelerometer_as_gyro();
    std::optional<PlainModel> plain = plain_model(recording);
    if (!plain) {
        return Error{
            ErrorCode::failed,
            fmt::format(
                "'{}' has no part of four seconds in which nothing turns, for --auto "
                "to take white noise and bias from: give a --model, and where it was turned a reference "
                "(columns ref_x_dps ... or ref_qw ...)",
                path)};
    }
    ModelFile file;
    std::vector<std::string> noise;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        if (recording.find(std::string("g") + axis_names[axis]) == nullptr) { continue; }
        noise.push_back(fmt::format("{:.3g} ({})",
                                    plain->model.axes[axis].noise.N_rad_per_sqrt_s * unit.per_column_unit,
                                    axis_names[axis]));
    }
    file.notes.push_back(
        fmt::format("the model is white noise and a bias, taken from {:.6g} s to {:.6g} s of the recording: "
                    "N {} {}/sqrt(Hz), read off the Allan deviation at {:.6g} s",
                    plain->still.from_s, plain->still.to_s, fmt::join(noise, ", "), unit.name, plain->tau_s));
    file.model = std::move(plain->model);
    return file;
}

// With the unnamed forms where they are wanted.
SensorModel model_of(const RecordingDiagnosisRequest& request, const Diagnosis& diagnosis) {
    return request.with_unnamed ? with_unnamed(diagnosis.corrected, diagnosis) : diagnosis.corrected;
}

// Of one sensor, or of the gyro and then the accelerometer.
using Diagnoses = std::vector<Diagnosis>;

SensorModel model_of(const RecordingDiagnosisRequest& request, const Diagnoses& diagnoses) {
    SensorModel model = model_of(request, diagnoses.front());
    if (diagnoses.size() > 1) { model.accelerometer = model_of(request, diagnoses.back()).accelerometer; }
    return model;
}

std::vector<std::string> shared_by(const Diagnoses& diagnoses) {
    return shared_causes(diagnoses.front(), diagnoses.back());
}

std::string text_of(const RecordingDiagnosisRequest& request, const Diagnoses& diagnoses) {
    const Wording wording = request.is_verbose ? Wording::whole : Wording::brief;
    const std::string text = diagnoses.size() == 1 ? diagnosis_text(diagnoses.front(), wording)
                                                   : diagnosis_text(diagnoses.front(), diagnoses.back(),
                                                                    shared_by(diagnoses), wording);
    return request.is_verbose ? text
                              : text +
                                    "\n--verbose tells all parameters, all places, and what could not be "
                                    "tested.\n";
}

std::string json_of(const Diagnoses& diagnoses) {
    return diagnoses.size() == 1 ? diagnosis_json(diagnoses.front())
                                 : diagnosis_json(diagnoses.front(), diagnoses.back(), shared_by(diagnoses));
}

// Of a file that is a name.
std::string name_of(const std::string& path) { return std::filesystem::path(path).filename().string(); }

Status write_results(Console& console, const RecordingDiagnosisRequest& request, const Diagnoses& diagnoses,
                     const CorrectedOutput& corrected) {
    std::vector<std::string> told;
    ResultOutput results(console);
    if (request.json_path != "-") {
        results.show_verdict(text_of(request, diagnoses));
    } else {
        for (const Diagnosis& diagnosis : diagnoses) { tell_warnings(console, diagnosis.warnings); }
    }
    results.text(request.json_path, [&] { return json_of(diagnoses); });
    for (const Diagnosis& diagnosis : diagnoses) {
        if (request.plot_path.empty()) { break; }
        const bool is_second = &diagnosis != &diagnoses.front();
        const std::string path = is_second ? path_of_accelerometer(request.plot_path) : request.plot_path;
        results.file(path, [&, path] {
            return write_diagnosis_plot(diagnosis, "recording", diagnosis_facts(diagnosis), request.paper,
                                        path);
        });
    }
    results.file(request.model_out_path, [&]() -> Status {
        GYROLOG_TRY(const std::string text,
                    corrected_text(corrected, model_of(request, diagnoses), name_of(request.recording_path),
                                   request.horizon_s, told));
        return write_file(request.model_out_path, as_bytes(text));
    });
    Status done = results.finish();
    tell_notices(console, told);
    return done;
}

// What is asked is looked for in all samples at once.
Result<std::vector<DescribedEffect>> read_questions(const RecordingDiagnosisRequest& request,
                                                    const DiagnosisInput& read) {
    std::vector<DescribedEffect> questions;
    if (request.asked_paths.empty()) { return questions; }
    if (read.means != nullptr) {
        return invalid_argument(
            "--ask: the recording is too long to be looked at in one piece: take a part "
            "of it with --from and --to");
    }
    for (const std::string& path : request.asked_paths) {
        GYROLOG_TRY(DescribedEffect described, read_described_effect(path));
        questions.push_back(std::move(described));
    }
    return questions;
}

RecordingInput input_of(const RecordingDiagnosisRequest& request, SensorKind sensor) {
    RecordingInput input{request.recording_path, request.rate_hz, request.lsb_dps};
    input.lsb_g = request.lsb_g;
    input.sensor = sensor;
    input.in_known_poses = true;
    input.samples_per_row = request.average;
    input.part = request.part;
    input.unit = request.unit;
    input.text = request.text;
    return input;
}

Status check_rest(const DiagnosisInput& read, const RecordingInput& input) {
    if (input.sensor != SensorKind::accelerometer) { return {}; }
    for (const auto& recording : {read.samples, read.means}) {
        if (recording != nullptr) { GYROLOG_CHECK(refuse_moving_accelerometer(*recording, input.path)); }
    }
    return {};
}

// Of a gyro.
Status check_turns(const DiagnosisInput& read, const SensorModel& model, const RecordingInput& input) {
    if (input.sensor != SensorKind::gyro) { return {}; }
    for (const auto& recording : {read.samples, read.means}) {
        if (recording != nullptr) {
            GYROLOG_CHECK(refuse_unreferenced_motion(*recording, model, input.path));
        }
    }
    return {};
}

// What is found against known forces is not judged where they are not known, nor the other way round.
Status check_exposure(const Recording& first, const Recording& second, const RecordingInput& second_input) {
    if (second_input.sensor != SensorKind::accelerometer || exposure_of(first) == exposure_of(second)) {
        return {};
    }
    const bool is_posed = exposure_of(first) == Exposure::known;
    return Error{ErrorCode::failed,
                 fmt::format("--holdout '{}': the accelerometer {}, and that of the recording {}: take two "
                             "recordings of one kind",
                             second_input.path, is_posed ? "rests in one pose" : "is set down in known poses",
                             is_posed ? "is set down in known poses" : "rests in one pose")};
}

// Before the gyro is diagnosed for minutes.
Status check_accelerometer(const RecordingDiagnosisRequest& request) {
    const RecordingInput input = input_of(request, SensorKind::accelerometer);
    GYROLOG_TRY(const DiagnosisInput read, read_for_diagnosis(input));
    return check_rest(read, input);
}

// `source`: the model; null: one of the recording's own.
Result<Diagnosis> diagnose_with(Console& console, const RecordingDiagnosisRequest& request,
                                const ModelSource* source, SensorKind sensor) {
    const bool is_plain = source == nullptr;
    ModelFile file;
    // What a plain model of an accelerometer is put in has a gyro of which nothing is known.
    SensorModel whole;
    whole.full_scale_rad_s = whole.saturation_rad_s = no_range_rad_s;
    RecordingInput input = input_of(request, sensor);
    GYROLOG_TRY(const DiagnosisInput read, read_for_diagnosis(input));
    GYROLOG_CHECK(check_rest(read, input));
    const Exposure exposure = exposure_of(*read.samples);
    if (!is_plain) {
        whole = source->file.model;
        GYROLOG_TRY(file, model_of_sensor(source->file, sensor, request.model_path, exposure));
    }
    if (is_plain) { GYROLOG_TRY(file, read_plain_model(*read.samples, sensor, request.recording_path)); }
    complete_from(*read.samples, file);
    GYROLOG_CHECK(check_turns(read, file.model, input));
    whole.rate_hz = file.model.rate_hz;
    DiagnosisInput second;
    if (!request.holdout_path.empty()) {
        input.path = request.holdout_path;
        input.part = {};
        GYROLOG_TRY(second, read_for_diagnosis(input, read));
        GYROLOG_CHECK(check_rest(second, input));
        GYROLOG_CHECK(check_turns(second, file.model, input));
        GYROLOG_CHECK(check_exposure(*read.samples, *second.samples, input));
    }
    std::optional<ProgressLine> progress(std::in_place, console);
    DiagnosisOptions options = options_of(*progress, request);
    options.holdout = second.samples;
    GYROLOG_TRY(options.asked, read_questions(request, read));
    const std::string name = is_plain ? "white noise and bias" : source->name;
    auto diagnosis = read.means != nullptr
                         ? diagnose_long({read.samples, read.means}, file.model, name, options, second.means)
                     : request.average > 1 ? diagnose_means(read, file.model, name, options)
                                           : diagnose_in_motion(read.samples, file.model, name, options);
    progress.reset();
    append_warnings(diagnosis->warnings, read);
    append_new(diagnosis->warnings, file.notes);
    append_warnings(diagnosis->warnings, second);
    return sensor == SensorKind::gyro ? *std::move(diagnosis)
                                      : diagnosis_of_accelerometer(*std::move(diagnosis), whole, exposure);
}

// Nothing without a path.
Result<std::optional<ModelSource>> read_source(const std::string& path) {
    if (path.empty()) { return std::optional<ModelSource>(); }
    GYROLOG_TRY(ModelSource source, read_single_model(path));
    return std::optional(std::move(source));
}

}  // namespace

Result<Diagnosis> diagnose_recording(Console& console, const RecordingDiagnosisRequest& request,
                                     SensorKind sensor) {
    GYROLOG_TRY(const std::optional<ModelSource> source, read_source(request.model_path));
    return diagnose_with(console, request, source ? &*source : nullptr, sensor);
}

std::vector<std::string> diagnosis_facts(const Diagnosis& diagnosis) {
    std::vector<std::string> facts{
        fmt::format("{} simulations, seed {}", diagnosis.simulations, diagnosis.seed),
        fmt::format("{:.6g} Hz, {}", diagnosis.rate_hz, format_duration(diagnosis.duration_s))};
    if (diagnosis.unit.sensor == SensorKind::accelerometer) {
        facts.insert(facts.begin(), "the accelerometer");
    }
    if (!diagnosis.passes.empty()) { facts.push_back(passes_text(diagnosis)); }
    for (const Cause& cause : diagnosis.causes) {
        for (const CauseSize& size : cause_sizes(cause)) {
            if (size.values.empty()) { continue; }
            facts.push_back(fmt::format("{}{}{}: {}", cause.finding.effect, size.axes.empty() ? "" : " on ",
                                        size.axes, fmt::join(size.values, ", ")));
        }
    }
    return facts;
}

ExitCode diagnose_recording_to_files(Console& console, const RecordingDiagnosisRequest& request) {
    const auto fail = [&](const Error& error) { return report_error(console, "diagnose", error); };
    std::vector<NamedPath> read = {{"RECORDING", request.recording_path},
                                   {"--model", request.model_path},
                                   {"--holdout", request.holdout_path}};
    for (const std::string& path : request.asked_paths) { read.push_back({"--ask", path}); }
    const std::string second_plot =
        is_figure_file(request.plot_path) ? path_of_accelerometer(request.plot_path) : std::string();
    const NamedPath written[] = {{"--json", request.json_path},
                                 {"--plot", request.plot_path},
                                 {"--plot's figure of the accelerometer", second_plot},
                                 {"--model-out", request.model_out_path}};
    if (const Status fine = check_output_paths(read, written); !fine.ok()) { return fail(fine.error()); }
    const auto read_model = read_source(request.model_path);
    if (!read_model.ok()) { return fail(read_model.error()); }
    const ModelSource* source = read_model->has_value() ? &**read_model : nullptr;
    const auto corrected = corrected_output(request.model_out_path, source);
    if (!corrected.ok()) { return fail(corrected.error()); }
    Diagnoses diagnoses;
    if (request.sensors == Sensors::all) {
        if (const Status fine = check_accelerometer(request); !fine.ok()) { return fail(fine.error()); }
    }
    for (const SensorKind sensor : {SensorKind::gyro, SensorKind::accelerometer}) {
        if (!includes(request.sensors, sensor)) { continue; }
        Result<Diagnosis> diagnosis = diagnose_with(console, request, source, sensor);
        if (!diagnosis.ok()) { return fail(diagnosis.error()); }
        diagnoses.push_back(*std::move(diagnosis));
    }
    const Status done = write_results(console, request, diagnoses, *corrected);
    return done.ok() ? ExitCode::ok : fail(done.error());
}

}  // namespace gyrolog
