#include "host/app/report_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include "analysis/noise/analyze.hpp"
#include "host/app/capture_report.hpp"
#include "host/app/command.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/progress_line.hpp"
#include "host/app/recording_diagnosis_run.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/report_figures.hpp"
#include "host/app/result_output.hpp"
#include "host/report/report_page.hpp"

namespace gyrolog {
namespace {

Status check_paths(const ReportRequest& request) {
    const NamedPath read[] = {{"RECORDING", request.recording_path}, {"--model", request.model_path}};
    const NamedPath written[] = {{"--output", request.page_path}};
    if (Status fine = check_output_paths(read, written); !fine.ok()) { return fine; }
    return check_ending(written[0], "a page", page_endings);
}

std::optional<TemperatureRange> temperature_of(const Recording& recording) {
    const Column* column = recording.find("temp");
    if (column == nullptr) { return std::nullopt; }
    std::optional<TemperatureRange> range;
    for (std::size_t i = 0; i < column->size(); ++i) {
        const double value = column->value(i);
        if (std::isnan(value)) { continue; }
        if (!range) { range = {value, value}; }
        range->lowest_degC = std::min(range->lowest_degC, value);
        range->highest_degC = std::max(range->highest_degC, value);
    }
    return range;
}

std::vector<Dropout> dropouts_of(const Recording& recording) {
    std::vector<Dropout> dropouts = recording.dropouts;
    std::erase_if(dropouts, [](const Dropout& dropout) { return dropout.cause == stopped_cause; });
    return dropouts;
}

RecordingDiagnosisRequest diagnosis_request(const ReportRequest& request) {
    RecordingDiagnosisRequest diagnosis;
    diagnosis.recording_path = request.recording_path;
    diagnosis.model_path = request.model_path;
    diagnosis.rate_hz = request.rate_hz;
    diagnosis.lsb_dps = request.lsb_dps;
    diagnosis.lsb_g = request.lsb_g;
    diagnosis.part = request.part;
    diagnosis.text = request.text;
    diagnosis.simulations = request.simulations;
    diagnosis.seed = request.seed;
    return diagnosis;
}

Result<std::string> page_of(const ReportRequest& request, const TimedRecording& read,
                            const AnalysisReport& analysis, const Diagnosis* diagnosis) {
    ReportPage page{analysis, {}, dropouts_of(read.recording), temperature_of(read.recording), diagnosis};
    if (read.capture) { page.about = info_lines(request.recording_path, *read.capture); }
    if (const Status drawn = draw_figures(page, read.recording); !drawn.ok()) { return drawn.error(); }
    return report_html(page);
}

}  // namespace

ExitCode report_to_file(Console& console, const ReportRequest& request) {
    std::optional<ProgressLine> progress;
    const auto fail = [&](const Error& error) {
        progress.reset();  // else the message stands behind the line
        return report_error(console, "report", error);
    };
    if (const Status fine = check_paths(request); !fine.ok()) { return fail(fine.error()); }
    // First, so that a model that is none is told of at once.
    std::optional<Diagnosis> diagnosis;
    if (!request.model_path.empty()) {
        Result<Diagnosis> made = diagnose_recording(console, diagnosis_request(request));
        if (!made.ok()) { return fail(made.error()); }
        diagnosis = std::move(made).value();
    }
    RecordingInput input{request.recording_path, request.rate_hz, request.lsb_dps};
    input.part = request.part;
    input.text = request.text;
    input.lsb_g = request.lsb_g;
    input.needs_gyro = false;
    progress.emplace(console);
    input.on_share = progress->of_reading();
    const auto read = read_timed_recording(input);
    if (!read.ok()) { return fail(read.error()); }
    AnalysisOptions options;
    options.threads = std::max(1U, std::thread::hardware_concurrency());
    options.on_stage = StageObserver([&](const char* stage) { progress->show_analysis(stage); });
    const AnalysisReport analysis = analyze(read->recording, options);
    if (!analysis.has_axes()) {
        return fail({ErrorCode::failed, request.recording_path +
                                            ": there is no angular rate and no specific force to report on"});
    }
    progress->show("drawing");
    const auto page = page_of(request, *read, analysis, diagnosis ? &*diagnosis : nullptr);
    if (!page.ok()) { return fail(page.error()); }
    progress.reset();
    ResultOutput results(console);
    results.text(request.page_path, [&] { return *page; });
    const Status written = results.finish();
    return written.ok() ? ExitCode::ok : fail(written.error());
}

}  // namespace gyrolog
