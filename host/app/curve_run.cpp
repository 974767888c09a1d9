#include "host/app/curve_run.hpp"

#include <fmt/format.h>

#include "analysis/noise/curve_report.hpp"
#include "host/app/command.hpp"
#include "host/app/curve_model_file.hpp"
#include "host/app/curve_plot.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/result_output.hpp"
#include "host/formats/curve_csv.hpp"
#include "host/formats/curve_json.hpp"
#include "host/formats/curve_text.hpp"
#include "host/formats/model_json.hpp"

namespace gyrolog {
namespace {

void warn(Console& console, const char* command, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) { say_warning(console, command, warning); }
}

Status write_results(Console& console, const char* command, const CurveRequest& request,
                     const CurveReport& report) {
    ResultOutput results(console);
    if (request.json_path != "-") { results.show(curve_text(report)); }
    results.text(request.json_path, [&] { return curve_json(report); });
    results.file(request.plot_path,
                 [&] { return write_curve_plot(report, request.paper, request.plot_path); });
    results.file(request.model_path, [&]() -> Status {
        GYROLOG_TRY(const ModelOfCurves result, model_of_curves(report, request.rate_hz));
        warn(console, command, result.warnings);
        return write_model(result.model, request.model_path);
    });
    return results.finish();
}

}  // namespace

ExitCode analyze_curve_to_files(Console& console, const char* command, const CurveRequest& request) {
    const NamedPath read[] = {{"--curve", request.curve_path}};
    const NamedPath written_paths[] = {
        {"--json", request.json_path}, {"--plot", request.plot_path}, {"--model", request.model_path}};
    if (const Status fine = check_output_paths(read, written_paths); !fine.ok()) {
        return report_error(console, command, fine.error());
    }
    auto curves = read_curve_csv(request.curve_path);
    if (!curves.ok()) { return report_error(console, command, curves.error()); }
    CurveFitOptions options;
    options.confidence = request.confidence;
    const CurveReport report = analyze_curves(std::move(curves).value(), options);
    if (request.json_path == "-") { warn(console, command, report.warnings); }
    const Status written = write_results(console, command, request, report);
    return written.ok() ? ExitCode::ok : report_error(console, command, written.error());
}

}  // namespace gyrolog
