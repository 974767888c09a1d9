#include "host/app/capture_run.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "host/app/capture_notices.hpp"
#include "host/app/capture_report.hpp"
#include "host/app/command.hpp"
#include "host/app/former_id.hpp"
#include "host/app/live_view.hpp"
#include "host/app/quantity.hpp"
#include "host/app/stop_signal.hpp"
#include "host/base/byte_size.hpp"
#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/stops_text.hpp"
#include "host/session/load_capture.hpp"

namespace gyrolog {
namespace {

double seconds_of(const CaptureOutcome& outcome, std::uint64_t instants) {
    const double rate_hz = outcome.progress.rate_hz.value_or(0.0);
    return rate_hz > 0.0 ? static_cast<double>(instants) / rate_hz : 0.0;
}

// The disk refused at some point: what counts is what the file gives back.
void keep_what_is_stored(const std::string& path, const CaptureOutcome& outcome, LinkReport& link) {
    const auto stored = load_capture(path, false);
    if (!stored.ok()) { return; }
    link = stored->decoder->report();
    link.samples.missing +=
        outcome.link.samples.good - std::min(outcome.link.samples.good, link.samples.good);
}

void sum_up(Console& console, const CaptureOutcome& outcome, const LinkReport& link,
            const std::string& path) {
    console.notices() << fmt::format(
        "  {}: {} in {}, {}\n", printable(path), counted(link.samples.good, "sample"),
        format_duration(seconds_of(outcome, link.instants())), format_bytes(outcome.progress.file_bytes));
    if (link.samples.missing > 0 || link.frames.missing > 0) {
        console.err << fmt::format("  missing: {}, {}; run `gyrolog check {}` for each\n", missing_text(link),
                                   counted(link.frames.missing, "frame"), shell_word(path));
    }
    if (!link.stops.empty()) {
        console.err << fmt::format("  {}\n",
                                   stops_text(link.stops.size(), seconds_of(outcome, link.samples_in_stops)));
    }
    if (link.samples_frozen > 0) {
        console.err << fmt::format("  one reading came again and again, {}: the sensor hung\n",
                                   counted(link.samples_frozen, "time"));
    }
    if (link.frames.corrupted > 0) {
        console.err << fmt::format("  refused: {}\n", counted(link.frames.corrupted, "damaged frame"));
    }
    if (link.samples_in_joins > 0 || !link.joins.empty()) {
        console.err << fmt::format("  {} of them while the board was away or began anew\n",
                                   format_count(link.samples_in_joins));
    }
    if (outcome.paths.size() > 1) {
        console.err << fmt::format(
            "  in {} files, {} to {}: every command takes them all by the first one's name\n",
            outcome.paths.size(), outcome.paths.front(), outcome.paths.back());
    }
    if (link.hellos_contradicting > 0) {
        console.err << fmt::format(
            "  the board contradicted itself {} about its clock or its number: its first word holds; "
            "`gyrolog conform` shows more\n",
            counted(link.hellos_contradicting, "time"));
    }
    if (outcome.transfers_dropped > 0) {
        console.err << fmt::format("  lost on this computer, whose queue was full: {} ({})\n",
                                   counted(outcome.transfers_dropped, "transfer"),
                                   format_bytes(outcome.bytes_dropped));
    }
}

ExitCode exit_code_of(const CaptureOutcome& outcome) {
    switch (outcome.end) {
        case CaptureEnd::device_lost:
            return ExitCode::device_lost;
        case CaptureEnd::storage_failed:
            return ExitCode::disk_full;
        case CaptureEnd::complete:
        case CaptureEnd::interrupted:
            break;
    }
    return outcome.data_lost() ? ExitCode::data_lost : ExitCode::ok;
}

// Hands the samples on to several.
class Observers final : public SampleObserver {
public:
    void add(SampleObserver* observer) {
        if (observer != nullptr) { observers_.push_back(observer); }
    }
    void on_decoder(const StreamDecoder& decoder) override {
        for (SampleObserver* observer : observers_) { observer->on_decoder(decoder); }
    }
    void on_start() override {
        for (SampleObserver* observer : observers_) { observer->on_start(); }
    }
    void on_samples(const glp_frame& frame, const glp_samples& samples, const glp_config& config) override {
        for (SampleObserver* observer : observers_) { observer->on_samples(frame, samples, config); }
    }

private:
    std::vector<SampleObserver*> observers_;
};

// Says what a live denoiser has to say, below what the view has drawn.
void tell_denoising(Console& console, LiveDenoise* denoise, LiveView* view) {
    if (denoise == nullptr) { return; }
    for (const std::string& notice : denoise->take_notices()) {
        if (view != nullptr) { view->finish(); }
        console.err << "  " << notice << '\n';
    }
}

// On a terminal: with the live view and its keys.
Result<CaptureOutcome> watch_capture(Console& console, ByteSource& source, CaptureRequest request,
                                     LiveDenoise* denoise) {
    const TidyEnd tidy;
    Observers observers;
    observers.add(denoise);
    request.observer = &observers;
    if (!console.progress) {
        ParkingNotice parking(console);
        StallNotice stall(console);
        SilenceNotice silence(console);
        return run_capture(source, request, [&](const CaptureProgress& progress) {
            stall.tell(progress);
            silence.tell(progress);
            parking.tell(progress);
            tell_denoising(console, denoise, nullptr);
            return !console.stop_wanted();
        });
    }
    CaptureControl control;
    LiveAllan allan;
    observers.add(&allan);
    request.control = &control;
    LiveKeys keys(control);
    TerminalKeys terminal;
    LiveView view(console, allan, keys);
    if (denoise != nullptr) { view.add(*denoise); }
    ParkingNotice parking(console, &view);
    StallNotice stall(console);
    SilenceNotice silence(console, &view);
    auto outcome = run_capture(source, request, [&](const CaptureProgress& progress) {
        keys.take(terminal.read());
        stall.tell(progress);
        silence.tell(progress);
        parking.tell(progress);
        tell_denoising(console, denoise, &view);
        if (!progress.parked && progress.hello) { view.show(progress); }
        const bool end = console.stop_wanted() || keys.end_wanted();
        if (end) { keys.finish(); }
        return !end;
    });
    view.finish();
    if (keys.note()) { console.err << "  the capture ended before the mark was finished: it is not kept\n"; }
    return outcome;
}

// After the capture, whose own success is said already.
void sum_up_denoising(Console& console, const char* command, LiveDenoise& denoise, CaptureResult& result) {
    const auto done = denoise.finish();
    tell_denoising(console, &denoise, nullptr);
    if (done.ok()) {
        console.err << "  " << *done << '\n';
        return;
    }
    const ExitCode code = report_error(console, command, done.error());
    if (result.code == ExitCode::ok) { result.code = code; }
}

}  // namespace

CaptureResult capture_to_file(Console& console, const char* command, const CaptureOptions& options,
                              const std::string& path, bool real_time) {
    CaptureResult result;
    auto request = options.request();
    if (!request.ok()) {
        result.code = report_error(console, command, request.error());
        return result;
    }
    request->path = path;
    auto opened = open_source(options.devices.front(), {request->duration_s, request->samples}, real_time);
    if (!opened.ok()) {
        report_error(console, command, opened.error());
        result.code = exit_code_of_opening(opened.error());
        return result;
    }
    std::unique_ptr<LiveDenoise> denoise;
    if (options.denoise.wanted()) {
        auto made = LiveDenoise::create({options.denoise, options.denoise.output_of(path), path,
                                         options.force, opened->source->can_wait()});
        if (!made.ok()) {
            result.code = report_error(console, command, made.error());
            return result;
        }
        denoise = std::move(made).value();
    }
    return capture_source_to_file(console, command, std::move(opened).value(), std::move(request).value(),
                                  real_time, denoise.get());
}

CaptureResult capture_source_to_file(Console& console, const char* command, OpenedSource opened,
                                     CaptureRequest request, bool real_time, LiveDenoise* denoise) {
    const bool limited = request.has_limit();
    if (opened.keeps_limit) {
        request.duration_s.reset();
        request.samples.reset();
    }
    ByteSource& source = *opened.source;
    console.notices() << "capturing from " << printable(source.identity().uri) << " to "
                      << printable(request.path)
                      << (real_time && console.progress ? "; q or Ctrl-C closes the file and analyses it\n"
                                                        : "\n");
    warn_of_former_id(console, command, source.identity());
    if (denoise != nullptr) { console.notices() << "  " << denoise->announcement() << '\n'; }
    const auto outcome = watch_capture(console, source, request, denoise);
    CaptureResult result = tell_outcome(console, command, outcome, request.path, limited);
    if (denoise != nullptr && result.file_written) { sum_up_denoising(console, command, *denoise, result); }
    return result;
}

CaptureResult tell_outcome(Console& console, const char* command, const Result<CaptureOutcome>& outcome,
                           const std::string& path, bool limited) {
    CaptureResult result;
    if (!outcome.ok()) {
        report_error(console, command, outcome.error());
        const bool ended = outcome.error().code == ErrorCode::failed && console.stop_wanted();
        result.code = ended ? ended_by_signal(console.signal->load()) : exit_code_of_opening(outcome.error());
        return result;
    }
    result.file_written = !outcome->kept_old;
    result.link = outcome->link;
    if (result.file_written && outcome->end == CaptureEnd::storage_failed) {
        keep_what_is_stored(path, *outcome, result.link);
    }
    result.code = exit_code_of(*outcome);
    if (outcome->error) {
        console.err << program_and(command) << ": " << outcome->error->message
                    << (outcome->end == CaptureEnd::device_lost
                            ? "; the board is lost, what came before is saved\n"
                            : "; what was written before is saved\n");
    }
    if (outcome->kept_old) {
        console.err << program_and(command) << ": not one sample came; '" << printable(path)
                    << "' is as it was\n";
    } else {
        sum_up(console, *outcome, result.link, path);
    }
    if (limited && outcome->end == CaptureEnd::interrupted && console.stop_wanted()) {
        console.err << fmt::format("  ended by a signal ({}) before all that was asked for was there\n",
                                   console.signal->load());
        if (result.code == ExitCode::ok) { result.code = ended_by_signal(console.signal->load()); }
    }
    return result;
}

}  // namespace gyrolog
