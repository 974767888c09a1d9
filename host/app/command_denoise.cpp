#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "analysis/plot/denoise_figure.hpp"
#include "analysis/simulate/accelerometer_as_gyro.hpp"
#include "host/app/array_input.hpp"
#include "host/app/command.hpp"
#include "host/app/denoise_choice.hpp"
#include "host/app/denoise_knowledge.hpp"
#include "host/app/figure_file.hpp"
#include "host/app/model_help.hpp"
#include "host/app/option_check.hpp"
#include "host/app/output_paths.hpp"
#include "host/app/part_options.hpp"
#include "host/app/progress_line.hpp"
#include "host/app/quantity.hpp"
#include "host/app/recording_input.hpp"
#include "host/app/result_output.hpp"
#include "host/app/sensor_choice.hpp"
#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/denoise_json.hpp"
#include "host/formats/denoise_text.hpp"
#include "host/formats/json.hpp"
#include "host/formats/model_json.hpp"
#include "host/formats/recording_csv.hpp"

namespace gyrolog {
namespace {

struct Request {
    ArrayInput input;
    std::string output;
    DenoiseChoice choice;
    std::string still;        // "FROM,TO" in seconds
    std::string calibration;  // another recording, at rest
    std::vector<std::string> models;
    std::string duration;
    PartChoice part;  // to which --still and --duration refer
    std::optional<double> saturation_dps;
    bool all_methods = false;
    std::string align = "clock";
    std::string json_path;  // "-" is standard output; empty: not wanted
    std::string plot_path;
    PaperSize paper{};
};

Result<TimeSpan> parse_span(const std::string& text) {
    TimeSpan span;
    const char* const end = text.data() + text.size();
    const auto from = std::from_chars(text.data(), end, span.from_s);
    if (from.ec == std::errc() && from.ptr != end && *from.ptr == ',') {
        const auto to = std::from_chars(from.ptr + 1, end, span.to_s);
        if (to.ec == std::errc() && to.ptr == end && span.from_s >= 0.0 && span.to_s > span.from_s) {
            return span;
        }
    }
    return invalid_argument("--still '" + text +
                            "': wants two times in seconds from the first sample, FROM,TO, such as 0,120");
}

// What rates are shown in: SI, unless the columns are counts without a scale.
struct ShownUnit {
    std::string name = "dps";
    double per_column_unit = deg_per_rad;
    std::string on_figure = "°/s";
    std::string quantity = "rate";
};

ShownUnit shown_unit(const Column& column, SensorKind sensor) {
    if (sensor == SensorKind::accelerometer) {
        const SensorUnit unit = unit_of_accelerometer_as_gyro();
        return {unit.name, unit.per_column_unit, unit.name, "specific force"};
    }
    if (column.unit == "lsb") { return {"lsb", 1.0, "lsb"}; }
    if (column.source_unit == "rad_s") { return {"rad/s", 1.0, "rad/s"}; }
    return {};
}

class DenoiseRun {
public:
    explicit DenoiseRun(const Request& request) : request_(request) {}

    Status run(Console& console) {
        ProgressLine progress(console);
        progress.show("reading");
        GYROLOG_TRY(recording_, read_input());
        GYROLOG_CHECK(check_array());
        GYROLOG_TRY(std::vector<DenoiseDesign> designs, choose_designs());
        progress.show("learning the noise of the units");
        GYROLOG_CHECK(find_still());
        GYROLOG_TRY(std::vector<AxisKnowledge> knowledge, learn());
        progress.show("denoising");
        DenoiseRequest work;
        work.designs = std::move(designs);
        work.still = still_;
        work.threads = 0;
        report_.axes = denoise(recording_, std::move(knowledge), work);
        fill_report();
        return {};
    }

    const DenoiseReport& report() const { return report_; }

    Status write_recording() const {
        CsvWriteOptions options;
        for (const AxisDenoising& axis : report_.axes) {
            options.resolved.push_back(prefix() + axis.knowledge.axis);
        }
        Recording denoised = denoised_recording(recording_, report_.axes);
        if (sensor() == SensorKind::accelerometer) { denoised = accelerometer_of_gyro(std::move(denoised)); }
        return write_recording_csv(denoised, request_.output, options);
    }

    Status write_plot() const {
        const ShownUnit unit = shown_unit(*array_axes(recording_).front().units.front(), sensor());
        DenoiseFigure figure{recording_, report_.axes, still_, {}, unit.on_figure, unit.per_column_unit};
        figure.quantity = unit.quantity;
        figure.paper = request_.paper;
        figure.facts = {fmt::format("{:.6g} Hz", recording_.rate_hz), format_duration(report_.duration_s),
                        counted(array_axes(recording_).front().units.size(), "unit"),
                        design_text(report_.axes.front().signals.front().design)};
        return write_figure(render(figure), request_.plot_path);
    }

private:
    SensorKind sensor() const { return request_.input.sensor; }
    // Of the names of its columns.
    std::string prefix() const { return sensor() == SensorKind::gyro ? "g" : "a"; }

    Result<Recording> read_input() const {
        ArrayInput input = request_.input;
        input.align_starts = request_.align == "start";
        std::optional<double> duration_s;
        if (!request_.duration.empty()) {
            GYROLOG_TRY(duration_s, parse_duration_s(request_.duration));
            input.simulated_s = *duration_s;
        }
        GYROLOG_TRY(Recording recording, read_array(input));
        GYROLOG_TRY(recording, take_part(std::move(recording), request_.part, request_.input.paths.front()));
        if (duration_s) {
            recording = part_of(recording, {0.0, *duration_s});
            if (recording.rows() == 0) {
                return invalid_argument("--duration '" + request_.duration + "' holds no sample");
            }
        }
        return recording;
    }

    Status check_array() const {
        const std::vector<ArrayAxis> axes = array_axes(recording_);
        if (axes.empty()) { return Error{ErrorCode::failed, "'" + recording_.name + "' has no gyro column"}; }
        for (const ArrayAxis& axis : axes) {
            if (axis.units.size() > units_max) {
                return Error{ErrorCode::unsupported,
                             fmt::format("'{}' has {} units on axis {}; an array has at most {}",
                                         recording_.name, axis.units.size(), axis.name, units_max)};
            }
            for (const Column* unit : axis.units) {
                if (unit->unit != axis.units.front()->unit) {
                    return Error{ErrorCode::failed,
                                 fmt::format("'{}': {} and {} have different units; give the counts' scale "
                                             "with --lsb-dps",
                                             recording_.name, axis.units.front()->name, unit->name)};
                }
            }
        }
        return {};
    }

    Result<std::vector<DenoiseDesign>> choose_designs() const {
        GYROLOG_TRY(const DenoiseDesign chosen, design_of(request_.choice, recording_.rate_hz));
        std::vector<DenoiseDesign> designs{chosen};
        if (!request_.all_methods) { return designs; }
        for (const DenoiseMethod method : all_denoise_methods) {
            if (method == chosen.method) { continue; }
            DenoiseDesign other = chosen;
            other.method = method;
            other.rate = default_rate_design(method, recording_.rate_hz);
            const bool told = request_.choice.bandwidth_hz || !request_.choice.rate_model.empty();
            if (told && method != DenoiseMethod::wavelet) { other.rate = chosen.rate; }
            designs.push_back(other);
        }
        return designs;
    }

    bool names_still() const { return !request_.still.empty() && request_.still != "auto"; }

    Status find_still() {
        if (names_still()) {
            GYROLOG_TRY(still_, parse_span(request_.still));
            if (segments_within(recording_.segments, recording_.rate_hz, still_).empty()) {
                return invalid_argument(
                    fmt::format("--still {}: the recording has no sample there, it lasts {:.6g} s",
                                request_.still, recording_.duration_s()));
            }
            const double duration_s = recording_.duration_s();
            // A board's clock may make a minute that much shorter.
            constexpr double clock_rel = 0.02;
            if (still_.to_s > duration_s * (1.0 + clock_rel)) {
                return invalid_argument(
                    fmt::format("--still {}: the recording lasts only {:.6g} s", request_.still, duration_s));
            }
            still_.to_s = std::min(still_.to_s, duration_s);
            return {};
        }
        still_ = still_part_of(recording_);
        return {};
    }

    Result<Recording> calibration_recording() const {
        RecordingInput input{request_.calibration, request_.input.rate_hz, request_.input.lsb_dps};
        input.text = request_.input.text;
        input.lsb_g = request_.input.lsb_g;
        input.sensor = sensor();
        GYROLOG_TRY(Recording other, read_recording(input));
        const std::vector<ArrayAxis> here = array_axes(recording_);
        const std::vector<ArrayAxis> there = array_axes(other);
        bool same = here.size() == there.size();
        for (std::size_t i = 0; same && i < here.size(); ++i) {
            same = here[i].name == there[i].name && here[i].units.size() == there[i].units.size();
        }
        if (!same) {
            return invalid_argument("--calibration '" + request_.calibration +
                                    "' does not have the axes and units that '" + recording_.name + "' has");
        }
        return other;
    }

    Result<std::vector<AxisKnowledge>> learn() {
        std::optional<double> saturation;
        if (request_.saturation_dps) { saturation = *request_.saturation_dps * rad_per_deg; }
        if (!request_.models.empty() && request_.calibration.empty() && !(still_.to_s > still_.from_s) &&
            is_single()) {
            std::vector<AxisKnowledge> known = know_units(recording_, saturation);
            GYROLOG_CHECK(tell_models(use_model_files(known, request_.models, recording_.rate_hz, sensor())));
            report_.learned_from = "of " + request_.models.front();
            return known;
        }
        Recording still;
        if (!request_.calibration.empty()) {
            GYROLOG_TRY(still, calibration_recording());
            report_.learned_from = "of " + request_.calibration;
        } else {
            if (!(still_.to_s > still_.from_s)) {
                return Error{
                    ErrorCode::failed,
                    "'" + recording_.name +
                        "' has no part of a few seconds at rest from which the units' noise could be "
                        "learned: name one with --still FROM,TO, or a recording at rest with "
                        "--calibration FILE"};
            }
            GYROLOG_TRY(still, rows_at_rest(recording_, still_));
            report_.learned_from =
                fmt::format("of {:.6g} s to {:.6g} s, at rest{}", still_.from_s, still_.to_s,
                            !names_still() ? " as it seems (--still says otherwise)" : "");
        }
        std::vector<AxisKnowledge> knowledge = learn_units(still, saturation);
        for (const AxisKnowledge& axis : knowledge) {
            for (const UnitKnowledge& unit : axis.units) {
                if (unit.variance > 0.0) { continue; }
                report_.warnings.push_back(
                    fmt::format("{}{}{} does not change at rest: its noise is not known", prefix(), axis.axis,
                                unit.name));
            }
        }
        GYROLOG_CHECK(take_models(knowledge));
        return knowledge;
    }

    // A gyro with which no other can be correlated needs no part at rest besides its model.
    bool is_single() const {
        return std::ranges::all_of(array_axes(recording_),
                                   [](const ArrayAxis& axis) { return axis.units.size() == 1; });
    }

    Status tell_models(const Result<std::vector<std::string>>& notes) {
        if (!notes.ok()) { return notes.error(); }
        report_.warnings.insert(report_.warnings.end(), notes->begin(), notes->end());
        return {};
    }

    Status take_models(std::vector<AxisKnowledge>& knowledge) {
        if (request_.models.empty()) { return {}; }
        GYROLOG_CHECK(tell_models(use_model_files(knowledge, request_.models, recording_.rate_hz, sensor())));
        report_.learned_from = "of " + fmt::format("{}", fmt::join(request_.models, ", ")) +
                               ", correlation " + report_.learned_from;
        return {};
    }

    void fill_report() {
        report_.name =
            request_.input.paths.front().starts_with("sim:") ? request_.input.paths.front() : recording_.name;
        if (request_.input.paths.size() > 1) {
            report_.name = fmt::format("{} recordings, {} first", request_.input.paths.size(),
                                       printable(recording_.name));
        }
        report_.rate_hz = recording_.rate_hz;
        report_.duration_s = recording_.duration_s();
        report_.samples = recording_.rows();
        report_.still = still_;
        report_.warnings.insert(report_.warnings.begin(), recording_.warnings.begin(),
                                recording_.warnings.end());
        const ShownUnit unit = shown_unit(*array_axes(recording_).front().units.front(), sensor());
        report_.unit = unit.name;
        report_.per_column_unit = unit.per_column_unit;
        for (const AxisDenoising& axis : report_.axes) { warn_of(axis); }
    }

    void warn_of(const AxisDenoising& axis) {
        warn_of_discord(axis);
        for (const UnitKnowledge& unit : axis.knowledge.units) {
            std::size_t left_out = 0;
            for (const UnitFailure& failure : axis.failures) {
                if (failure.unit == unit.name) { left_out += failure.samples; }
            }
            if (left_out == 0) { continue; }
            report_.warnings.push_back(
                fmt::format("{}{}{} is left out at {} of {} samples (below: why and when)", prefix(),
                            axis.knowledge.axis, unit.name, left_out, recording_.rows()));
        }
    }

    // Where most units seem noisy at one time or another it is not they that failed.
    void warn_of_discord(const AxisDenoising& axis) {
        std::size_t suspects = 0;
        for (const UnitKnowledge& unit : axis.knowledge.units) {
            std::size_t noisy = 0;
            for (const UnitFailure& failure : axis.failures) {
                if (failure.unit == unit.name && failure.state == UnitState::noisy) {
                    noisy += failure.samples;
                }
            }
            if (100 * noisy > recording_.rows()) { ++suspects; }
        }
        if (2 * suspects < axis.knowledge.units.size() || suspects < 2) { return; }
        report_.warnings.push_back(
            fmt::format("on axis {} {} of {} units part from each other by more than noise: units of an "
                        "array must have parallel "
                        "axes (a flipped one has the other sign), equal scales and one clock; --no-watch "
                        "keeps all of them in",
                        axis.knowledge.axis, suspects, axis.knowledge.units.size()));
    }

    const Request& request_;
    Recording recording_;
    TimeSpan still_;
    DenoiseReport report_;
};

Status write_results(Console& console, const Request& request, const DenoiseRun& run) {
    const DenoiseReport& report = run.report();
    ResultOutput results(console);
    if (request.json_path == "-") {
        for (const std::string& warning : report.warnings) { say_warning(console, "denoise", warning); }
    } else {
        results.show(denoise_text(report));
    }
    results.file(request.output, [&] { return run.write_recording(); });
    results.json(request.json_path, [&] { return denoise_json(report); });
    results.file(request.plot_path, [&] { return run.write_plot(); });
    return results.finish();
}

// What one unit says twice is no second opinion.
Status check_units(const std::vector<std::string>& paths) {
    for (std::size_t i = 0; i < paths.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (!same_file(paths[j], paths[i])) { continue; }
            return invalid_argument(
                fmt::format("'{}' and '{}' are the same recording: each unit of an array "
                            "has its own",
                            paths[j], paths[i]));
        }
    }
    return {};
}

ExitCode denoise_command(Console& console, const Request& request) {
    const auto fail = [&](const Error& error) { return report_error(console, "denoise", error); };
    const Status named = check_ending({"--output", request.output}, "a denoised recording", text_endings);
    if (!named.ok()) { return fail(named.error()); }
    const std::vector<std::string> files = files_of_array(request.input);
    std::vector<NamedPath> read;
    read.reserve(files.size() + request.models.size() + 1);
    for (const std::string& path : files) { read.push_back({"RECORDING", path}); }
    for (const std::string& path : request.models) { read.push_back({"--model", path}); }
    read.push_back({"--calibration", request.calibration});
    const NamedPath outputs[] = {
        {"--output", request.output}, {"--json", request.json_path}, {"--plot", request.plot_path}};
    if (const Status fine = check_output_paths(read, outputs); !fine.ok()) { return fail(fine.error()); }
    if (const Status units = check_units(request.input.paths); !units.ok()) { return fail(units.error()); }
    DenoiseRun run(request);
    if (const Status done = run.run(console); !done.ok()) { return fail(done.error()); }
    const Status written = write_results(console, request, run);
    return written.ok() ? ExitCode::ok : fail(written.error());
}

void add_filter_options(CLI::App& app, Request& request) {
    app.add_option("--method", request.choice.method,
                   "kalman: the units combined; wavelet: its threshold on what is combined; joint: both")
        ->check(CLI::IsMember({"kalman", "wavelet", "joint"}))
        ->capture_default_str();
    app.add_option(
           "--bandwidth", request.choice.bandwidth_hz,
           "Of the rate that passes the Kalman filter; without it kalman passes all, joint a fourth of "
           "the sampling rate")
        ->type_name("HZ")
        ->check(number_from_to(1e-6, 1e7, "Hz"));
    app.add_option(
           "--rate-model", request.choice.rate_model,
           "How the rate moves: free (no smoothing), walk (first order), trend (second order, without "
           "lag at constant acceleration), adaptive (narrow when calm, the whole bandwidth in motion)")
        ->check(CLI::IsMember({"free", "walk", "trend", "adaptive"}));
    app.add_option("--gain", request.choice.gain,
                   "varying: by what is known at each sample; steady: the settled gain from the first on")
        ->check(CLI::IsMember({"varying", "steady"}))
        ->capture_default_str();
    app.add_option("--window", request.choice.window, "Of the wavelet: samples it looks back")
        ->check(whole_number(14, 65536))
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--no-watch", request.choice.watch_off, "Do not leave units out that fail");
    app.add_option("--saturation", request.saturation_dps,
                   "Size of rate at which a unit is saturated; without it counts at the end of 16 bits are")
        ->type_name("DPS")
        ->check(positive_number());
}

void add_input_options(CLI::App& app, Request& request) {
    app.add_option("RECORDING", request.input.paths,
                   "One recording with several gyros (gx1 gx2 ...) or one, several of the same time, or "
                   "sim:boards=N,...")
        ->required();
    app.add_option("--still", request.still,
                   "The part at rest from which the units' noise is learned, or auto, which finds it")
        ->type_name("FROM,TO");
    add_time_options(app, request.part);
    app.add_option("--calibration", request.calibration, "A recording of the same units at rest, instead")
        ->type_name("RECORDING");
    app.add_option("--model", request.models,
                   std::string("The units' noise, one for all or one for each: ") + model_file_help)
        ->type_name("FILE");
    app.add_option("--align", request.align,
                   "Several recordings: by their clocks, or by their first samples (start)")
        ->check(CLI::IsMember({"clock", "start"}))
        ->capture_default_str();
    app.add_option("--duration", request.duration,
                   "The first part only; of a simulated array its length (60s)")
        ->type_name("T")
        ->check(duration());
    app.add_option("--rate", request.input.rate_hz, "Sampling rate, in place of what time stamps say")
        ->type_name("HZ")
        ->check(positive_number());
    add_text_options(app, request.input.text);
    app.add_option("--lsb-dps", request.input.lsb_dps, lsb_dps_help)
        ->type_name("DPS")
        ->check(positive_number());
    app.add_option("--lsb-g", request.input.lsb_g, lsb_g_help)->type_name("G")->check(positive_number());
    app.add_option_function<std::string>(
           "--sensor",
           [&request](const std::string& name) {
               request.input.sensor = name == "gyro" ? SensorKind::gyro : SensorKind::accelerometer;
           },
           "Which sensor: gyro, or accelerometer")
        ->check(CLI::IsMember({"gyro", "accelerometer"}))
        ->type_name("SENSOR")
        ->excludes(app.get_option("--saturation"));
}

}  // namespace

Action setup_denoise(CLI::App& app) {
    auto request = std::make_shared<Request>();
    add_filter_options(app, *request);
    add_input_options(app, *request);
    app.add_option(
           "-o,--output", request->output,
           "The denoised recording: gx gy gz, with time stamps and other columns as they were, or ax ay az "
           "with the temperature (.csv, "
           ".gz, .xz, .zst)")
        ->type_name("FILE");
    app.add_flag("--all-methods", request->all_methods, "Report all three methods side by side");
    app.add_option("--json", request->json_path, "Write the report as JSON (- for standard output)")
        ->type_name("FILE");
    app.add_option("--plot", request->plot_path, "Draw before and after")
        ->type_name(figure_file_type)
        ->check(figure_file());
    add_paper_options(app, request->paper);
    return [request](Console& console) { return denoise_command(console, *request); };
}

}  // namespace gyrolog
