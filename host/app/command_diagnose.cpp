#include <memory>
#include <optional>
#include <string>

#include "host/app/command.hpp"
#include "host/app/curve_diagnosis_run.hpp"
#include "host/app/figure_file.hpp"
#include "host/app/many_recordings.hpp"
#include "host/app/model_help.hpp"
#include "host/app/option_check.hpp"
#include "host/app/part_options.hpp"
#include "host/app/quantity.hpp"
#include "host/app/recording_diagnosis_run.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/app/simulation_count.hpp"

namespace gyrolog {
namespace {

constexpr unsigned threads_most = 1024;
constexpr int gyro_most = 999'999;
constexpr int average_most = 100'000;

struct DiagnoseOptions {
    RecordingDiagnosisRequest request;
    ManyRecordings many;
    std::string curve_path;
    std::string horizon = "1h";
    bool is_plain = false;
    std::string sensor = "gyro";
    std::optional<unsigned long> unit;
    std::string reference;
};

ExitCode diagnose_recordings(Console& console, const DiagnoseOptions& options) {
    const RecordingDiagnosisRequest& request = options.request;
    const NamedPath read[] = {{"--model", request.model_path}, {"--holdout", request.holdout_path}};
    const NamedPath of_one[] = {{"--holdout", request.holdout_path},
                                {"--plot", request.plot_path},
                                {"--model-out", request.model_out_path}};
    const auto run = [&](Console& own, const std::string& recording, bool as_line) {
        RecordingDiagnosisRequest one = request;
        one.sensors = sensors_named(options.sensor);
        one.unit = {options.unit, !options.reference.empty()};
        one.recording_path = recording;
        if (as_line) { one.json_path = "-"; }
        return diagnose_recording_to_files(own, one);
    };
    return run_on_recordings(console, "diagnose", options.many, {read, of_one}, run);
}

ExitCode diagnose_either(Console& console, DiagnoseOptions& options) {
    RecordingDiagnosisRequest& request = options.request;
    const auto wrong = [&](const char* problem) {
        return report_error(console, "diagnose", {ErrorCode::invalid_argument, problem});
    };
    if (options.many.recordings.empty() == options.curve_path.empty()) {
        return wrong(options.curve_path.empty() ? "give a RECORDING, or --curve with an Allan curve"
                                                : "give a RECORDING or --curve, not both");
    }
    const auto horizon_s = parse_duration_s(options.horizon);
    if (!horizon_s.ok()) {
        return report_error(console, "diagnose", in_context("--horizon", horizon_s.error()));
    }
    request.horizon_s = *horizon_s;
    if (!options.curve_path.empty()) {
        return diagnose_curve_to_files(
            console, {options.curve_path, request.model_path, request.json_path, request.plot_path,
                      request.model_out_path, request.paper, request.horizon_s});
    }
    if (request.model_path.empty() && !options.is_plain) {
        return wrong(
            "give the --model that the recording is to be held against, or --auto for one of white "
            "noise and a bias");
    }
    if (!request.asked_paths.empty() && (options.sensor != "gyro" || request.average > 1)) {
        return wrong("--ask is for the gyro's samples as they are: without --sensor and --average");
    }
    if (options.unit && options.sensor != "gyro") {
        return wrong("--gyro is for the gyro: without --sensor");
    }
    return diagnose_recordings(console, options);
}

}  // namespace

Action setup_diagnose(CLI::App& app) {
    auto options = std::make_shared<DiagnoseOptions>();
    RecordingDiagnosisRequest& request = options->request;
    CLI::Option* model =
        app.add_option("--model", request.model_path,
                       std::string("The sensor model whose gap is sought: ") + model_file_help)
            ->type_name("FILE");
    CLI::Option* plain =
        app.add_flag("--auto", options->is_plain,
                     "Instead of a model: white noise and bias of the recording's quiet part");
    plain->excludes(model);
    CLI::Option* curve =
        app.add_option("--curve", options->curve_path,
                       "Instead of a recording: an Allan curve from print (tau_s,x_dps, ...); "
                       "without --model against its own simulation_x_dps")
            ->type_name("FILE.csv");
    app.add_option("--json", request.json_path, "Write the diagnosis as JSON (- for standard output)")
        ->type_name("FILE");
    add_recordings(app, options->many, "RECORDING",
                   "A capture (.pcapng), text (.csv, .csv.xz, ...), .mat or .npy");
    app.add_option("--plot", request.plot_path,
                   "Draw the shares of the causes, and where recording and model part before and after them")
        ->type_name(figure_file_type)
        ->check(figure_file());
    add_paper_options(app, request.paper);
    app.add_option(
           "--model-out", request.model_out_path,
           "Write the model with the causes added: a simulator's file as the same kind of file, changed, "
           "or gyrolog's own (.json, .model.json)")
        ->type_name("FILE");
    app.add_option(
           "--horizon", options->horizon,
           "With --model-out as a simulator's file: averaging times up to this count where noise can only "
           "be approximated")
        ->type_name("TIME")
        ->check(duration())
        ->needs(app.get_option("--model-out"))
        ->capture_default_str();
    app.add_flag("--unnamed", request.with_unnamed, "Into --model-out also what was modelled without a name")
        ->needs(app.get_option("--model-out"));
    app.add_flag("--verbose", request.is_verbose,
                 "Tell all parameters, all places and rivals, and what could not be tested");
    app.add_option("--holdout", request.holdout_path,
                   "A second recording of the sensor: the gap is measured on it")
        ->type_name("RECORDING");
    app.add_option("--ask", request.asked_paths,
                   "An effect described in a file (gyrolog-effect/1): whether the data call for it; may be "
                   "given again")
        ->type_name("FILE.json")
        ->allow_extra_args(false);
    app.add_option("--average", request.average,
                   "Look at means of N samples: all of a long recording, for what is slow")
        ->type_name("N")
        ->check(whole_number(1, average_most))
        ->capture_default_str();
    app.add_option("--simulations", request.simulations, "How many simulations tell a gap from chance")
        ->type_name("N")
        ->check(whole_number(simulations_least, simulations_most))
        ->capture_default_str();
    app.add_option("--seed", request.seed, "Other simulations of the same kind")
        ->type_name("N")
        ->check(whole_number(0))
        ->capture_default_str();
    app.add_option("--threads", request.threads,
                   "0: all processors, as far as memory allows; the answer is the same")
        ->type_name("N")
        ->check(whole_number(0, threads_most))
        ->capture_default_str();
    app.add_option("--rate", request.rate_hz, "Sampling rate of recordings, in place of the one in the file")
        ->type_name("HZ")
        ->check(sampling_rate());
    add_text_options(app, request.text);
    app.add_option("--lsb-dps", request.lsb_dps, lsb_dps_help)->type_name("DPS")->check(positive_number());
    app.add_option("--lsb-g", request.lsb_g, lsb_g_help)->type_name("G")->check(positive_number());
    app.add_option(
           "--sensor", options->sensor,
           "Which sensor: gyro, accelerometer (at rest, or in known poses), or all that the model has")
        ->check(CLI::IsMember({"gyro", "accelerometer", "all"}))
        ->type_name("SENSOR")
        ->capture_default_str();
    app.add_option("--gyro", options->unit, "Which gyro of an array: 2 is gx2, gy2, gz2")
        ->type_name("N")
        ->check(whole_number(0, gyro_most));
    app.add_option("--reference", options->reference,
                   "others: what the array's other gyros say of the motion is the reference of --gyro")
        ->type_name("others")
        ->check(CLI::IsMember({"others"}))
        ->needs(app.get_option("--gyro"));
    add_part_options(app, request.part);
    for (const char* of_recordings :
         {"--auto",        "--verbose",  "--unnamed", "--holdout", "--ask",  "--average",
          "--simulations", "--seed",     "--threads", "--lsb-dps", "--rate", "--columns",
          "--unit",        "--acc-unit", "--lsb-g",   "--sensor",  "--gyro", "--reference",
          "--from",        "--to",       "--still",   "--jsonl"}) {
        curve->excludes(app.get_option(of_recordings));
    }
    return [options](Console& console) { return diagnose_either(console, *options); };
}

}  // namespace gyrolog
