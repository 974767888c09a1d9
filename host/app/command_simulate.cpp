#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "host/app/capture_run.hpp"
#include "host/app/command.hpp"
#include "host/app/option_check.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/quantity.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/result_output.hpp"
#include "host/app/simulation_run.hpp"
#include "host/base/byte_size.hpp"
#include "host/base/counted.hpp"
#include "host/capture/append_file.hpp"
#include "host/formats/effect_catalogue.hpp"
#include "host/formats/json.hpp"
#include "host/formats/model_source.hpp"
#include "host/virtual_board/sim_source.hpp"

namespace gyrolog {
namespace {

constexpr double duration_without_wish_s = 3600.0;
constexpr double samples_max = 1099511627776.0;  // 2^40

struct SimulateOptions {
    std::string model;
    std::string output;
    std::string duration;
    std::uint64_t seed = 1;
    std::string like;
    std::optional<double> rate_hz;
    std::string model_out;
    std::string json;
    bool effects = false;
    bool force = false;

    bool makes_capture() const { return output.ends_with(".pcapng"); }
};

// What the answer says beyond the outcome.
struct Story {
    ModelFile file;
    std::optional<double> duration_s;
    std::shared_ptr<const RecordedWorld> like;
    std::vector<std::string> warnings;
};

Status check(const SimulateOptions& options) {
    if (options.model.empty()) {
        return invalid_argument("give the MODEL to simulate, or --effects to see what a model may list");
    }
    if (options.output.empty()) { return invalid_argument("give the recording to write with -o"); }
    std::vector<const char*> endings(text_endings.begin(), text_endings.end());
    endings.push_back(".pcapng");
    GYROLOG_CHECK(check_ending({"--output", options.output}, "a recording", endings));
    if (options.makes_capture() && !options.like.empty()) {
        return invalid_argument(
            "--like with a capture: the virtual board makes its own time stamps; write a .csv instead");
    }
    const NamedPath read[] = {{"MODEL", options.model}, {"--like", options.like}};
    const NamedPath written[] = {
        {"--output", options.output}, {"--model-out", options.model_out}, {"--json", options.json}};
    return check_output_paths(read, written);
}

// "nonlinearity (x, z)", "bias_step": entries of one name together.
std::vector<std::string> effect_names(const SensorModel& model) {
    std::vector<std::pair<std::string, std::vector<std::string>>> found;
    for (const EffectModel& effect : model.effects) {
        auto entry = std::ranges::find_if(found, [&](const auto& x) { return x.first == effect.effect; });
        if (entry == found.end()) { entry = found.insert(found.end(), {effect.effect, {}}); }
        for (const std::string& axis : effect.axes) {
            if (std::ranges::count(entry->second, axis) == 0) { entry->second.push_back(axis); }
        }
    }
    std::vector<std::string> names;
    names.reserve(found.size());
    for (const auto& [name, axes] : found) {
        names.push_back(axes.empty() ? name : fmt::format("{} ({})", name, fmt::join(axes, ", ")));
    }
    return names;
}

Result<std::uint64_t> samples_of(double duration_s, double rate_hz) {
    const double samples = std::round(duration_s * rate_hz);
    if (samples < 1.0) {
        return invalid_argument(
            fmt::format("--duration {:g} s at {:g} Hz holds no sample", duration_s, rate_hz));
    }
    if (samples > samples_max) {
        return invalid_argument(
            fmt::format("--duration {:g} s at {:g} Hz is {:.3g} samples; at most 2^40 = {:.3g}", duration_s,
                        rate_hz, samples, samples_max));
    }
    return static_cast<std::uint64_t>(samples);
}

// Whether there can be room, before days of work. What is no file is none of the disk's.
Status check_room(const std::string& path, double bytes) {
    std::error_code unknown;
    const bool other =
        std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown);
    const auto free_bytes = computers_disk().free_bytes(path);
    if (other || !free_bytes.ok() || bytes <= static_cast<double>(*free_bytes)) { return {}; }
    return Error{ErrorCode::disk_full,
                 fmt::format("write '{}': it takes about {}, and its disk has {} left", path,
                             format_bytes(static_cast<std::uint64_t>(bytes)), format_bytes(*free_bytes))};
}

// The model is of one gyro with three axes, whatever the recording has.
void warn_of_axes(const Recording& recording, const std::string& name, std::vector<std::string>& warnings) {
    std::string lacking;
    for (const char* axis : axis_names) {
        if (recording.find(std::string("g").append(axis)) == nullptr) {
            lacking += (lacking.empty() ? "g" : ", g") + std::string(axis);
        }
    }
    const auto numbered = [](const Column& column) {
        return column.name.starts_with('g') && column.name.size() > 2;
    };
    if (std::ranges::any_of(recording.columns, numbered)) {
        warnings.push_back(name + " is of several gyros; one is simulated");
    } else if (!lacking.empty()) {
        warnings.push_back(name + " has no " + lacking + "; simulated all the same");
    }
}

Result<std::shared_ptr<const RecordedWorld>> read_like(const SimulateOptions& options, Story& story) {
    RecordingInput like{options.like, options.rate_hz, std::nullopt};
    like.needs_gyro = false;  // its rates are not taken
    auto read = read_recording(like);
    if (!read.ok()) { return in_context("--like", std::move(read).error()); }
    auto recording = std::make_shared<const Recording>(std::move(read).value());
    if (recording->rows() == 0) { return invalid_argument("--like '" + options.like + "' has no samples"); }
    for (const std::string& warning : recording->warnings) {
        story.warnings.push_back(options.like + ": " + warning);
    }
    complete_from(*recording, story.file);
    warn_of_axes(*recording, options.like, story.warnings);
    auto world = std::make_shared<const RecordedWorld>(recording);
    for (const std::string& warning : world->warnings()) {
        story.warnings.push_back(options.like + ": " + warning);
    }
    if (const auto terms = terms_of_stamps(story.file.model); !terms.empty()) {
        story.warnings.push_back(fmt::format("the time stamps are copied: {} of the model {} not act on them",
                                             fmt::join(terms, ", "), terms.size() == 1 ? "does" : "do"));
    }
    if (const auto terms = terms_of_temperature(story.file.model);
        world->has_temperature() && !terms.empty()) {
        story.warnings.push_back(fmt::format("the temperature is copied: {} of the model {} not act on it",
                                             fmt::join(terms, ", "), terms.size() == 1 ? "does" : "do"));
    }
    return std::shared_ptr<const RecordedWorld>(std::move(world));
}

std::string taken_over(const RecordedWorld& like) {
    std::string text = "time stamps";
    if (like.has_temperature()) { text += ", temperature"; }
    if (like.has_reference()) { text += ", reference rate"; }
    if (like.has_specific_force()) { text += ", specific force"; }
    return text;
}

std::string made_up(const RecordedWorld& like) {
    std::string text;
    if (!like.has_temperature()) { text += ", temperature"; }
    if (!like.has_reference()) { text += like.has_specific_force() ? ", no turning" : ", rest"; }
    return text.empty() ? text : "; not in it, so simulated: " + text.substr(2);
}

void tell(Console& console, const SimulateOptions& options, const Story& story,
          const SimulationOutcome& outcome) {
    console.notices() << fmt::format(
        "  {}: {} in {}, seed {}{}\n", options.output, counted(outcome.samples, "sample"),
        format_duration(static_cast<double>(outcome.instants) / outcome.rate_hz), options.seed,
        outcome.interrupted ? "; stopped early, whole up to there" : "");
    const auto effects = effect_names(story.file.model);
    if (!effects.empty()) { console.notices() << fmt::format("  effects: {}\n", fmt::join(effects, ", ")); }
    if (story.like) {
        console.notices() << fmt::format("  from {}: {}{}\n", options.like, taken_over(*story.like),
                                         made_up(*story.like));
    }
    if (outcome.instants != outcome.samples) {
        console.notices() << fmt::format("  missing: {} in {}\n",
                                         counted(outcome.instants - outcome.samples, "sample"),
                                         counted(outcome.dropouts, "dropout"));
    }
    for (const std::string& note : story.file.notes) { console.notices() << "  " << note << '\n'; }
}

Json answer(const SimulateOptions& options, const Story& story, const SimulationOutcome& outcome) {
    Json json;
    json["schema"] = "gyrolog-simulate/1";
    json["model"] = options.model;
    json["output"] = options.output;
    json["seed"] = options.seed;
    json["rate_hz"] = outcome.rate_hz;
    json["duration_s"] = static_cast<double>(outcome.instants) / outcome.rate_hz;
    json["samples"] = outcome.samples;
    json["missing"] = {{"samples", outcome.instants - outcome.samples}, {"dropouts", outcome.dropouts}};
    json["complete"] = !outcome.interrupted;
    json["effects"] = effect_names(story.file.model);
    if (story.like) {
        json["like"] = {{"file", options.like},
                        {"temperature", story.like->has_temperature()},
                        {"reference", story.like->has_reference()},
                        {"specific_force", story.like->has_specific_force()}};
    }
    json["notes"] = story.file.notes;
    json["warnings"] = story.warnings;
    return json;
}

// The unit itself, once nothing is left that could refuse it.
Status write_unit(Console& console, const SimulateOptions& options, const SensorModel& model) {
    ResultOutput results(console);
    results.text(options.model_out, [&] { return format_model(model); });
    return results.finish();
}

ExitCode make_text(Console& console, const SimulateOptions& options, Story& story) {
    const auto fail = [&](const Error& error) { return report_error(console, "simulate", error); };
    SimulationRequest request;
    request.seed = options.seed;
    if (!options.like.empty()) {
        auto like = read_like(options, story);
        if (!like.ok()) { return fail(like.error()); }
        story.like = request.like = std::move(like).value();
        request.accelerometer_in_poses = true;
    } else {
        request.rate_hz = options.rate_hz;
    }
    const double rate_hz =
        story.like ? story.like->recording().rate_hz : options.rate_hz.value_or(story.file.model.rate_hz);
    if (!story.like || story.duration_s) {
        const auto samples = samples_of(story.duration_s.value_or(duration_without_wish_s), rate_hz);
        if (!samples.ok()) { return fail(samples.error()); }
        request.samples = *samples;
    }
    // Compressed, a row may take next to nothing.
    if (options.output.ends_with(".csv")) {
        const Status room = check_room(options.output, text_bytes_of(story.file.model, request));
        if (!room.ok()) { return fail(room.error()); }
    }
    for (const std::string& warning : story.warnings) { say_warning(console, "simulate", warning); }
    if (const Status written = write_unit(console, options, story.file.model); !written.ok()) {
        return fail(written.error());
    }
    const auto outcome = simulate_to_text(console, story.file.model, request, options.output);
    if (!outcome.ok()) { return fail(outcome.error()); }
    tell(console, options, story, *outcome);
    ResultOutput results(console);
    results.json(options.json, [&] { return answer(options, story, *outcome); });
    if (const Status written = results.finish(); !written.ok()) { return fail(written.error()); }
    return outcome->interrupted ? ended_by_signal(console.signal->load()) : ExitCode::ok;
}

ExitCode make_capture(Console& console, const SimulateOptions& options, const Story& story) {
    SimOptions board;
    board.seed = options.seed;
    board.rate_hz = options.rate_hz;
    board.model_path = options.model;
    board.text = fmt::format("model={},seed={}", options.model, options.seed);
    const double duration_s = story.duration_s.value_or(duration_without_wish_s);
    auto source = SimSource::create(board, story.file.model, {std::nullopt, duration_s});
    if (!source.ok()) { return report_error(console, "simulate", source.error()); }
    const double samples = duration_s * options.rate_hz.value_or(story.file.model.rate_hz);
    const double bytes = (*source)->stream_bytes_per_sample() * samples;
    if (const Status room = check_room(options.output, bytes); !room.ok()) {
        return report_error(console, "simulate", room.error());
    }
    if (const Status written = write_unit(console, options, story.file.model); !written.ok()) {
        return report_error(console, "simulate", written.error());
    }
    CaptureRequest request;
    request.path = options.output;
    request.overwrite = options.force;
    request.duration_s = duration_s;
    const CaptureResult result =
        capture_source_to_file(console, "simulate", {std::move(source).value(), true}, request, false);
    if (!result.file_written) { return result.code; }
    for (const std::string& note : story.file.notes) { console.notices() << "  " << note << '\n'; }
    SimulationOutcome outcome;
    outcome.samples = result.link.samples.good;
    outcome.instants = outcome.samples + result.link.samples.missing;
    outcome.dropouts = result.link.dropouts.size() + result.link.dropouts_unlisted;
    outcome.rate_hz = options.rate_hz.value_or(story.file.model.rate_hz);
    outcome.interrupted = console.stop_wanted();
    ResultOutput results(console);
    results.json(options.json, [&] { return answer(options, story, outcome); });
    const Status written = results.finish();
    return written.ok() ? result.code : report_error(console, "simulate", written.error());
}

ExitCode show_effects(Console& console, const SimulateOptions& options) {
    const NamedPath paths[] = {{"--json", options.json}};
    if (const Status fine = check_output_paths({}, paths); !fine.ok()) {
        return report_error(console, "simulate", fine.error());
    }
    ResultOutput results(console);
    if (options.json.empty()) { results.show(effect_catalogue_text()); }
    results.json(options.json, effect_catalogue_json);
    const Status shown = results.finish();
    return shown.ok() ? ExitCode::ok : report_error(console, "simulate", shown.error());
}

ExitCode simulate(Console& console, const SimulateOptions& options) {
    if (options.effects) { return show_effects(console, options); }
    const auto fail = [&](const Error& error) { return report_error(console, "simulate", error); };
    if (const Status fine = check(options); !fine.ok()) { return fail(fine.error()); }
    Story story;
    if (!options.duration.empty()) {
        const auto duration_s = parse_duration_s(options.duration);
        if (!duration_s.ok()) { return fail(in_context("--duration", duration_s.error())); }
        story.duration_s = *duration_s;
    }
    auto source = read_model_source(options.model, options.seed);
    if (!source.ok()) { return fail(source.error()); }
    story.file = std::move(source->file);
    if (const auto refusal = simulation_refusal(story.file.model)) {
        return fail({ErrorCode::malformed, "model '" + options.model + "': " + *refusal +
                                               "; `gyrolog simulate --effects` lists what there is"});
    }
    if (story.file.unstated.rate && options.like.empty()) {
        if (!options.rate_hz) {
            return fail({ErrorCode::malformed, "model '" + options.model +
                                                   "': rate_hz is missing: state it there, or give --rate or "
                                                   "--like"});
        }
        state_rate(story.file, *options.rate_hz);
    }
    return options.makes_capture() ? make_capture(console, options, story)
                                   : make_text(console, options, story);
}

}  // namespace

Action setup_simulate(CLI::App& app) {
    auto options = std::make_shared<SimulateOptions>();
    app.add_option(
        "MODEL", options->model,
        "The sensor (.json): a gyrolog-model/1, a data sheet (gyrolog-datasheet/1), a population of "
        "units (gyrolog-population/1) or gyroparams (gyrolog-gyroparams/1); or a simulator's file, as for "
        "`diagnose --model`");
    app.add_option("-o,--output", options->output,
                   "The recording to write, by its ending: .csv (.gz, .xz, .zst), or .pcapng as the virtual "
                   "board sends it")
        ->type_name("FILE");
    app.add_option("--duration", options->duration,
                   "Length: 90s, 15m, 6h, 7d; without it 1h, or with --like that recording's")
        ->type_name("T")
        ->check(duration());
    app.add_option("--seed", options->seed, "Another sensor of the same kind")
        ->type_name("N")
        ->check(whole_number(0))
        ->capture_default_str();
    app.add_option("--like", options->like,
                   "Take time stamps, holes, temperature and reference motion from this recording")
        ->type_name("RECORDING");
    app.add_option("--rate", options->rate_hz, "Sampling rate, in place of the model's or the recording's")
        ->type_name("HZ")
        ->check(sampling_rate());
    app.add_option("--model-out", options->model_out,
                   "Write the simulated unit as gyrolog-model/1 (of a data sheet: the one that was drawn)")
        ->type_name("FILE");
    app.add_option("--json", options->json,
                   "Write what was done, or the effects, as JSON (- for standard output)")
        ->type_name("FILE");
    app.add_flag("--effects", options->effects,
                 "List the effects that a model may have, and their parameters");
    app.add_flag("--force", options->force, "Replace a capture that exists");
    return [options](Console& console) { return simulate(console, *options); };
}

}  // namespace gyrolog
