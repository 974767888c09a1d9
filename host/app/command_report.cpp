#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "host/app/command.hpp"
#include "host/app/fleet_report.hpp"
#include "host/app/model_help.hpp"
#include "host/app/option_check.hpp"
#include "host/app/part_options.hpp"
#include "host/app/report_run.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/app/simulation_count.hpp"

namespace gyrolog {
namespace {

struct ReportOptions {
    std::vector<std::string> inputs;
    std::string expected_path;
    ReportRequest of_recording;
};

// Empty, or what was given that only goes with the page of one recording.
std::string option_of_recording(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        std::string name = option->get_name();
        const bool is_of_both = name == "--output" || name == "--quiet" || name == "--expected";
        if (option->nonpositional() && option->count() > 0 && !is_of_both) { return name; }
    }
    return {};
}

ExitCode write_report(Console& console, const ReportOptions& options, const CLI::App& app) {
    const auto refuse = [&](const std::string& problem) {
        return report_error(console, "report", invalid_argument(problem));
    };
    const auto lines = std::ranges::count_if(options.inputs, is_named_like_lines);
    if (lines == 0) {
        if (options.inputs.size() > 1) {
            return refuse(
                "a page is of one recording; of several, give the results of `gyrolog analyze ... "
                "--jsonl FILE.jsonl`");
        }
        if (!options.expected_path.empty()) { return refuse("--expected goes with results (.jsonl) only"); }
        ReportRequest request = options.of_recording;
        request.recording_path = options.inputs.front();
        return report_to_file(console, request);
    }
    if (static_cast<std::size_t>(lines) < options.inputs.size()) {
        return refuse("a page is of one recording or of results (.jsonl), not of both");
    }
    if (const std::string name = option_of_recording(app); !name.empty()) {
        return refuse(name + " goes with a recording only, and '" + options.inputs.front() + "' has results");
    }
    return fleet_report_to_file(console,
                                {options.inputs, options.expected_path, options.of_recording.page_path});
}

}  // namespace

Action setup_report(CLI::App& app) {
    auto options = std::make_shared<ReportOptions>();
    ReportRequest* request = &options->of_recording;
    app.add_option("RECORDING", options->inputs,
                   "A capture (.pcapng), text (.csv, .csv.xz, ...), .mat or .npy; or what analyze, check, "
                   "compare and diagnose wrote with --jsonl about many recordings (.jsonl)")
        ->required();
    app.add_option("-o,--output", request->page_path, "The page, with its figures inside")
        ->type_name("FILE.html")
        ->required();
    app.add_option("--expected", options->expected_path,
                   "With .jsonl: names of recordings, one a line, of which those without an answer are told")
        ->type_name("LIST.txt");
    CLI::Option* model =
        app.add_option("--model", request->model_path,
                       std::string("Also diagnose where the recording parts from this sensor model: ") +
                           model_file_help)
            ->type_name("FILE");
    app.add_option("--simulations", request->simulations, "How many simulations tell a gap from chance")
        ->type_name("N")
        ->check(whole_number(simulations_least, simulations_most))
        ->needs(model)
        ->capture_default_str();
    app.add_option("--seed", request->seed, "Other simulations of the same kind")
        ->type_name("N")
        ->check(whole_number(0))
        ->needs(model)
        ->capture_default_str();
    app.add_option("--rate", request->rate_hz, "Sampling rate, in place of the one in the file")
        ->type_name("HZ")
        ->check(sampling_rate());
    add_part_options(app, request->part);
    add_text_options(app, request->text);
    app.add_option("--lsb-dps", request->lsb_dps, lsb_dps_help)->type_name("DPS")->check(positive_number());
    app.add_option("--lsb-g", request->lsb_g, lsb_g_help)->type_name("G")->check(positive_number());
    return [options, &app](Console& console) { return write_report(console, *options, app); };
}

}  // namespace gyrolog
