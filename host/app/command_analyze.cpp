#include <memory>
#include <string>
#include <vector>

#include "analysis/allan/allan_curve.hpp"
#include "host/app/analysis_run.hpp"
#include "host/app/command.hpp"

namespace gyrolog {

Action setup_analyze(CLI::App& app) {
    auto request = std::make_shared<AnalysisRequest>();
    app.add_option("RECORDING", request->recording_path,
                   "A capture (.pcapng) or text (.csv, .csv.xz, .csv.gz)")
        ->required();
    app.add_option("--json", request->json_path, "Write the report as JSON (- for standard output)")
        ->type_name("FILE");
    app.add_option("--plot", request->plot_path, "Draw the Allan curves")->type_name("FILE.png");
    app.add_option("--model", request->model_path, "Write the noise model for simulations")
        ->type_name("FILE");
    std::vector<std::string> deviations;
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
    app.add_option("--m", request->factors, "Averaging factors: 1,10,100")->type_name("LIST");
    app.add_option("--rate", request->rate_hz, "Sampling rate, in place of the one in the file")
        ->type_name("HZ")
        ->check(CLI::Range(1e-4, 1e7));
    app.add_option("--lsb-dps", request->lsb_dps, "Scale of gyro columns that are counts (_lsb)")
        ->type_name("DPS")
        ->check(CLI::PositiveNumber);
    app.add_option("--confidence", request->confidence, "Probability of the intervals")
        ->check(CLI::Range(0.01, 0.9999))
        ->type_name("P")
        ->capture_default_str();
    return [request](Console& console) { return analyze_to_files(console, "analyze", *request); };
}

}  // namespace gyrolog
