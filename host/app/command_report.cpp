#include <memory>

#include "host/app/command.hpp"
#include "host/app/model_help.hpp"
#include "host/app/option_check.hpp"
#include "host/app/part_options.hpp"
#include "host/app/report_run.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/app/simulation_count.hpp"

namespace gyrolog {

Action setup_report(CLI::App& app) {
    auto request = std::make_shared<ReportRequest>();
    app.add_option("RECORDING", request->recording_path,
                   "A capture (.pcapng), text (.csv, .csv.xz, ...), .mat or .npy")
        ->required();
    app.add_option("-o,--output", request->page_path, "The page, with its figures inside")
        ->type_name("FILE.html")
        ->required();
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
    return [request](Console& console) { return report_to_file(console, *request); };
}

}  // namespace gyrolog
