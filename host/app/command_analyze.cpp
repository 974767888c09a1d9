#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "host/app/analysis_run.hpp"
#include "host/app/command.hpp"
#include "host/app/curve_run.hpp"
#include "host/app/figure_file.hpp"
#include "host/app/many_recordings.hpp"
#include "host/app/option_check.hpp"
#include "host/app/part_options.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/app/stage_clock.hpp"
#include "host/app/text_options.hpp"

namespace gyrolog {
namespace {

struct AnalyzeOptions {
    AnalysisRequest request;
    ManyRecordings many;
    std::string curve_path;
    bool timing = false;
};

ExitCode analyze_curve(Console& console, const AnalyzeOptions& options) {
    const AnalysisRequest& request = options.request;
    return analyze_curve_to_files(console, "analyze",
                                  {options.curve_path, request.json_path, request.plot_path,
                                   request.model_path, request.rate_hz, request.confidence, request.paper});
}

ExitCode with_timing(Console& console, AnalyzeOptions& options,
                     const std::function<ExitCode(Console&)>& analyze) {
    if (!options.timing) { return analyze(console); }
    StageClock clock;
    options.request.on_stage = StageObserver([&clock](const char* stage) { clock.enter(stage); });
    const ExitCode code = analyze(console);
    clock.stop();
    options.request.on_stage = {};
    write_timing(console.err, clock);
    return code;
}

ExitCode analyze_either(Console& console, AnalyzeOptions& options) {
    AnalysisRequest& request = options.request;
    if (options.many.recordings.empty() == options.curve_path.empty()) {
        const char* problem = options.curve_path.empty() ? "give a RECORDING, or --curve with an Allan curve"
                                                         : "give a RECORDING or --curve, not both";
        return report_error(console, "analyze", {ErrorCode::invalid_argument, problem});
    }
    if (!options.curve_path.empty()) {
        return with_timing(console, options, [&](Console& own) { return analyze_curve(own, options); });
    }
    const NamedPath written[] = {{"--plot", request.plot_path},
                                 {"--histogram", request.histogram_path},
                                 {"--model", request.model_path}};
    const auto run = [&](Console& own, const std::string& recording, bool as_line) {
        request.recording_path = recording;
        if (as_line) { request.json_path = "-"; }
        return with_timing(own, options,
                           [&](Console& timed) { return analyze_to_files(timed, "analyze", request); });
    };
    return run_on_recordings(console, "analyze", options.many, {{}, written}, run);
}

}  // namespace

Action setup_analyze(CLI::App& app) {
    auto options = std::make_shared<AnalyzeOptions>();
    AnalysisRequest* request = &options->request;
    CLI::Option* curve =
        app.add_option(
               "--curve", options->curve_path,
               "Instead of a recording: an Allan curve from print (tau_s,x_dps or x_deg_per_h, x_ug, ...)")
            ->type_name("FILE.csv");
    app.add_option("--json", request->json_path, "Write the report as JSON (- for standard output)")
        ->type_name("FILE");
    add_recordings(app, options->many, "RECORDING",
                   "A capture (.pcapng), text (.csv, .csv.xz, ...), .mat or .npy");
    app.add_option("--plot", request->plot_path, "Draw the Allan curves and the spectra")
        ->type_name(figure_file_type)
        ->check(figure_file());
    app.add_option("--histogram", request->histogram_path, "Draw how the samples lie about the bias")
        ->type_name(figure_file_type)
        ->check(figure_file());
    add_paper_options(app, request->paper);
    app.add_option("--model", request->model_path, "Write the noise model for simulations")
        ->type_name("FILE");
    std::vector<std::string> deviations;
    deviations.reserve(all_deviation_kinds.size());
    for (const DeviationKind kind : all_deviation_kinds) { deviations.emplace_back(name_of(kind)); }
    app.add_option("--deviation", request->deviation,
                   "Which deviation (standard_halving: m = 1, 2, 4, ..., error 1/sqrt(2(n-1)) of n averages)")
        ->check(CLI::IsMember(deviations))
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--convention", request->convention,
                   "sp1065: phase with N+1 points, N+1-2m terms; matlab: N-2m terms")
        ->check(CLI::IsMember({"sp1065", "matlab"}))
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--m", request->factors,
                   "Averaging factors: 1,10,100; or all, which takes long on long recordings")
        ->type_name("LIST");
    app.add_option("--rate", request->rate_hz, "Sampling rate, in place of the one in the file")
        ->type_name("HZ")
        ->check(sampling_rate());
    app.add_option("--lsb-dps", request->lsb_dps, lsb_dps_help)->type_name("DPS")->check(positive_number());
    app.add_option("--lsb-g", request->lsb_g, lsb_g_help)->type_name("G")->check(positive_number());
    add_text_options(app, request->text);
    app.add_option("--sensor", request->sensor, "Which sensor: gyro, accelerometer, or all that there are")
        ->check(CLI::IsMember({"gyro", "accelerometer", "all"}))
        ->type_name("NAME")
        ->capture_default_str();
    add_part_options(app, request->part);
    app.add_flag("--robust", request->robust,
                 "First replace single samples that lie more than 6 robust standard deviations off their "
                 "neighbours");
    app.add_flag("--keep-temperature", request->keep_temperature,
                 "Analyse the noise with the drift that follows temp_C left in. Otherwise it is taken off "
                 "where it is there beyond chance (0.1 %)");
    app.add_option("--confidence", request->confidence, "Probability of the intervals")
        ->check(number_from_to(0.01, 0.9999))
        ->type_name("P")
        ->capture_default_str();
    app.add_flag("--timing", options->timing, "Print on standard error where the time went");
    for (const char* of_samples : {"--deviation", "--convention", "--m", "--robust", "--keep-temperature",
                                   "--histogram", "--lsb-dps", "--lsb-g", "--sensor", "--from", "--to",
                                   "--still", "--jsonl", "--columns", "--unit", "--acc-unit"}) {
        curve->excludes(app.get_option(of_samples));
    }
    return [options](Console& console) { return analyze_either(console, *options); };
}

}  // namespace gyrolog
