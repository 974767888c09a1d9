#include "host/app/capture_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "host/app/live_view.hpp"
#include "host/app/quantity.hpp"
#include "host/base/byte_size.hpp"
#include "host/base/counted.hpp"
#include "host/base/printable.hpp"
#include "host/formats/json.hpp"
#include "host/formats/stops_text.hpp"
#include "host/formats/text_width.hpp"
#include "host/formats/wrapped_text.hpp"

namespace gyrolog {
namespace {

const char* name_of(FileEnd end) {
    switch (end) {
        case FileEnd::clean:
            return "clean";
        case FileEnd::torn_tail:
            return "torn_tail";
        case FileEnd::damaged:
            return "damaged";
    }
    return "";
}

std::string hex(const std::uint8_t* bytes, std::size_t size) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) { text += fmt::format("{:02x}", bytes[i]); }
    return text;
}

// Sampling instants at the sensor's own rate; without a rate there is no length.
double duration_s(const LoadedCapture& capture, const LinkReport& link) {
    const auto rate_hz = capture.decoder->rate_hz();
    return rate_hz ? static_cast<double>(link.instants()) / *rate_hz : 0.0;
}

double stopped_s(const LoadedCapture& capture, const LinkReport& link) {
    const auto rate_hz = capture.decoder->rate_hz();
    return rate_hz ? static_cast<double>(link.samples_in_stops) / *rate_hz : 0.0;
}

Json stops_json(const LoadedCapture& capture, const LinkReport& link) {
    const double rate_hz = capture.decoder->rate_hz().value_or(0.0);
    Json stops = Json::array();
    for (const Dropout& stop : capture.decoder->timed(link.stops)) {
        const double lasted_s = rate_hz > 0.0 ? static_cast<double>(stop.samples) / rate_hz : 0.0;
        stops.push_back({{"at_s", stop.at_s}, {"s", lasted_s}});
    }
    return stops;
}

Json reasons_json(const LinkReport& link) {
    Json reasons = Json::object();
    for (std::size_t reason = 0; reason < link.frames.corrupted_by_reason.size(); ++reason) {
        if (const std::uint64_t count = link.frames.corrupted_by_reason[reason]; count > 0) {
            reasons[glp_status_name(static_cast<glp_status>(reason))] = count;
        }
    }
    return reasons;
}

// How much faster the board's clock runs than the host's, in parts per million.
struct ClockComparison {
    double ppm = 0.0;
    double sd_ppm = 0.0;
};

std::optional<ClockComparison> board_clock(const LoadedCapture& capture) {
    const auto fit = capture.decoder->timeline().host_clock();
    if (!fit || fit->ratio <= 0.0) { return std::nullopt; }
    return ClockComparison{(1.0 / fit->ratio - 1.0) * 1e6, fit->ratio_sd * 1e6};
}

// Device time of a mark, from the first sample; no value while the two clocks cannot be compared.
std::optional<double> at_s(const LoadedCapture& capture, const CaptureMark& mark) {
    const auto fit = capture.decoder->timeline().host_clock();
    if (!fit || fit->ratio <= 0.0) { return std::nullopt; }
    return (static_cast<double>(mark.time.monotonic_ns) * 1e-9 - fit->offset_s) / fit->ratio;
}

Json marks_json(const LoadedCapture& capture) {
    Json marks = Json::array();
    for (const CaptureMark& mark : capture.marks) {
        const auto at = at_s(capture, mark);
        marks.push_back({{"at_s", at ? Json(*at) : Json(nullptr)},
                         {"time", utc_text(mark.time.realtime_ns)},
                         {"text", mark.text}});
    }
    return marks;
}

std::string mark_text(const LoadedCapture& capture, const CaptureMark& mark) {
    const auto at = at_s(capture, mark);
    return fmt::format("{}  {}", at ? fmt::format("at {:.3f} s", *at) : utc_text(mark.time.realtime_ns),
                       mark.text.empty() ? "(no text)" : mark.text);
}

// How far the host's real-time clock was set, by somebody or by its time server, while the capture ran:
// nothing in the capture depends on it.
double host_clock_set_by_s(const LoadedCapture& capture) {
    if (!capture.metadata || !capture.last_checkpoint) { return 0.0; }
    const HostTime& began = capture.metadata->started;
    const HostTime& ended = capture.last_checkpoint->time;
    const double realtime_s =
        (static_cast<double>(ended.realtime_ns) - static_cast<double>(began.realtime_ns)) * 1e-9;
    const double monotonic_s =
        (static_cast<double>(ended.monotonic_ns) - static_cast<double>(began.monotonic_ns)) * 1e-9;
    const double set_by_s = realtime_s - monotonic_s;
    constexpr double slewing = 500e-6;  // what NTP may do without a step
    return std::abs(set_by_s) > 0.001 + slewing * std::abs(monotonic_s) ? set_by_s : 0.0;
}

// One row of a table: what, how much, and a remark.
std::string row(std::string_view what, std::uint64_t count, std::string_view remark = "") {
    return fmt::format("  {:<22}{:>16}{}{}\n", what, format_count(count), remark.empty() ? "" : "  ", remark);
}

std::string behind_close_text(const std::string& path, const BlockAccounts& file) {
    return fmt::format(
        "{} {} behind its end, where its writer had closed it. Run `gyrolog recover {} -o NEW` to leave them "
        "out",
        counted(file.bytes_behind_close, "byte"), file.bytes_behind_close == 1 ? "stands" : "stand",
        shell_word(path));
}

std::string end_text(const std::string& path, const LoadedCapture& capture) {
    const BlockAccounts& file = capture.file.blocks;
    switch (file.end) {
        case FileEnd::clean:
            return capture.closed_by_writer() ? "clean"
                                              : "clean, but the writer did not close it: it was stopped "
                                                "short, by a full disk or a kill";
        case FileEnd::torn_tail:
            if (file.only_behind_close()) { return behind_close_text(path, file); }
            return fmt::format(
                "torn tail: the writer died there. {} at the end {} in no whole block; all "
                "before is intact",
                counted(file.bytes_in_tail, "byte"), file.bytes_in_tail == 1 ? "is" : "are");
        case FileEnd::damaged:
            if (file.only_behind_close()) { return "damaged: " + behind_close_text(path, file); }
            return fmt::format(
                "damaged: {} bytes in {} {} are no intact blocks. Run `gyrolog recover {} -o NEW` to keep "
                "the intact part",
                format_count(file.bytes_damaged + file.bytes_in_tail), file.damaged_ranges,
                file.damaged_ranges == 1 ? "place" : "places", shell_word(path));
    }
    return "";
}

bool samples_complete(const LoadedCapture& capture) {
    return capture.decoder->report().complete() && capture.file.truncated_transfers == 0;
}

// The last line, which people read first.
std::string verdict(const LoadedCapture& capture) {
    const FileEnd end = capture.file.blocks.end;
    const bool longer = capture.file.blocks.only_behind_close();
    if ((end == FileEnd::damaged && !longer) || capture.stream_bytes_gone > 0) {
        return "damaged: something that was captured is gone";
    }
    if (!capture.contradictions().empty()) {
        return "the counters contradict the samples: how much is missing is not certain";
    }
    if (!samples_complete(capture)) { return "something is missing"; }
    if (longer) { return "nothing is missing; what stands behind the capture's end is no part of it"; }
    if (end == FileEnd::torn_tail) {
        return "nothing is missing before the torn tail; what came after it, when the writer died, is not "
               "here";
    }
    if (!capture.closed_by_writer()) {
        return "nothing is missing before the end; the writer was stopped there, and did not close the file";
    }
    return "nothing is missing";
}

}  // namespace

std::string board_name(const LoadedCapture& capture) {
    if (!capture.metadata) { return {}; }
    const SourceIdentity& source = capture.metadata->source;
    return source.uri.starts_with("sim:") ? source.uri : source.serial;
}

std::string started_utc(const LoadedCapture& capture) {
    const HostTime started = capture.metadata ? capture.metadata->started : capture.first_data;
    return started.realtime_ns == 0 ? "" : utc_text(started.realtime_ns);
}

bool nothing_missing(const LoadedCapture& capture) {
    return samples_complete(capture) && capture.file.blocks.end != FileEnd::damaged &&
           capture.stream_bytes_gone == 0 && capture.contradictions_of_writer.empty();
}

Json check_json(const std::string& path, const LoadedCapture& capture) {
    const LinkReport link = capture.decoder->report();
    const BlockAccounts& file = capture.file.blocks;
    const auto rate_hz = capture.decoder->rate_hz();
    Json dropouts = Json::array();
    for (const Dropout& dropout : capture.decoder->timed(link.dropouts)) {
        dropouts.push_back({{"at_s", dropout.at_s}, {"samples", dropout.samples}, {"cause", dropout.cause}});
    }
    return {
        {"schema", "gyrolog-check/1"},
        {"file", path},
        {"board", board_name(capture)},
        {"started", started_utc(capture)},
        {"rate_hz", rate_hz ? Json(*rate_hz) : Json(nullptr)},
        {"duration_s", duration_s(capture, link)},
        {"end", name_of(file.end)},
        {"closed", capture.closed_by_writer()},
        {"files", capture.files},
        {"bytes",
         {{"total", link.bytes.total},
          {"in_frames", link.bytes.in_frames},
          {"skipped", link.bytes.skipped},
          {"buffered", link.bytes.buffered},
          {"gone", capture.stream_bytes_gone}}},
        {"frames",
         {{"good", link.frames.good},
          {"missing", link.frames.missing},
          {"duplicated", link.frames.duplicated},
          {"corrupted", link.frames.corrupted}}},
        {"samples",
         {{"good", link.samples.good}, {"missing", link.samples.missing}, {"frozen", link.samples_frozen}}},
        {"dropouts", dropouts},
        {"dropouts_unlisted", link.dropouts_unlisted},
        {"stops", stops_json(capture, link)},
        {"contradictions", capture.contradictions()},
        {"corrupted_by_reason", reasons_json(link)},
        {"lost_on_device",
         {{"samples", link.samples.lost_on_device}, {"frames", link.frames.lost_on_device}}},
        {"frames_before_start", link.frames_before_start},
        {"boots", link.boots},
        {"runs", link.runs},
        {"file_bytes",
         {{"total", file.bytes_total},
          {"in_blocks", file.bytes_in_blocks},
          {"damaged", file.bytes_damaged},
          {"in_tail", file.bytes_in_tail}}},
        {"transfers", {{"total", capture.file.transfers}, {"failed", capture.file.failed_transfers}}}};
}

std::string check_text(const std::string& path, const LoadedCapture& capture) {
    const LinkReport link = capture.decoder->report();
    std::string text = printable(path) + "\n";
    if (capture.files.size() > 1) {
        text +=
            fmt::format("  in {} files, up to {}\n", capture.files.size(), printable(capture.files.back()));
    }
    text += wrapped_text("  end of file: ", end_text(path, capture));
    text += row("bytes of the stream", link.bytes.total);
    if (capture.stream_bytes_gone > 0) {
        text += row("  gone", capture.stream_bytes_gone, "its writer counted so many more");
    }
    text += row("  in frames", link.bytes.in_frames);
    text += row("  skipped", link.bytes.skipped,
                link.bytes_skipped_at_head > 0 ? fmt::format("{} of them before the first frame",
                                                             format_count(link.bytes_skipped_at_head))
                                               : "");
    text += row("  buffered", link.bytes.buffered, link.bytes.buffered > 0 ? "a frame that was cut off" : "");
    text += row("frames good", link.frames.good,
                link.frames_before_start > 0
                    ? fmt::format("and {} from before the start", format_count(link.frames_before_start))
                    : "");
    text += row("  missing", link.frames.missing);
    text += row("  duplicated", link.frames.duplicated);
    text += row("  corrupted", link.frames.corrupted);
    text += row("samples good", link.samples.good);
    text += row("  missing", link.samples.missing);
    if (link.samples_frozen > 0) {
        text += row("  frozen", link.samples_frozen, "one reading again and again: the sensor hung");
    }
    constexpr std::size_t shown = 20;
    const std::vector<Dropout> dropouts = capture.decoder->timed(link.dropouts);
    for (std::size_t i = 0; i < std::min(shown, dropouts.size()); ++i) {
        text += fmt::format("  dropout at {:.3f} s: {}, {}\n", dropouts[i].at_s,
                            counted(static_cast<std::uint64_t>(dropouts[i].samples), "sample"),
                            dropouts[i].cause);
    }
    if (const std::uint64_t more = dropouts.size() + link.dropouts_unlisted; more > shown) {
        text += fmt::format("  and {} (--json lists them)\n", counted(more - shown, "more dropout"));
    }
    if (!link.stops.empty()) {
        text += fmt::format("  {}\n", stops_text(link.stops.size(), stopped_s(capture, link)));
    }
    for (const std::string& contradiction : capture.contradictions()) {
        text += wrapped_text("  contradiction: ", contradiction);
    }
    text += wrapped_text("  ", verdict(capture));
    return text;
}

Json info_json(const std::string& path, const LoadedCapture& capture) {
    const LinkReport link = capture.decoder->report();
    Json board = Json::object();
    if (capture.metadata) {
        const SourceIdentity& source = capture.metadata->source;
        board["uri"] = source.uri;
        board["vid"] = fmt::format("{:04x}", source.vendor_id);
        board["pid"] = fmt::format("{:04x}", source.product_id);
        board["product"] = source.product;
        board["serial"] = source.serial;
    }
    if (const auto& hello = capture.decoder->hello()) {
        board["firmware"] = hello->firmware;
        board["uid"] = hex(hello->uid, sizeof hello->uid);
        board["boot_id"] = hello->boot_id;
        board["protocol"] = fmt::format("{}.{}", hello->protocol_major, hello->protocol_minor);
        board["tick_hz"] = hello->tick_hz;
    }
    Json sensor = Json::object();
    if (const auto& hello = capture.decoder->hello()) {
        sensor["name"] = hello->sensor;
        sensor["who_am_i"] = fmt::format("{:02x}", hello->who_am_i);
    }
    if (const auto& config = capture.decoder->config()) {
        sensor["rate_hz"] = config->rate_mHz * 1e-3;
        if (const auto rate_hz = capture.decoder->rate_hz()) { sensor["measured_rate_hz"] = *rate_hz; }
        if (const auto estimate = capture.decoder->rate_estimate()) {
            sensor["rate_sd_hz"] = estimate->sd_hz;
            sensor["stamp_jitter_s"] = estimate->jitter_s;
        }
        sensor["full_scale_dps"] = config->gyro_full_scale_dps;
        sensor["accel_full_scale_g"] = config->accel_full_scale_g;
        if (config->dlpf_hz == 0) {
            sensor["dlpf"] = "off";
        } else {
            sensor["dlpf"] = config->dlpf_hz;
        }
        sensor["registers"] = hex(config->registers, sizeof config->registers);
    }
    Json clock = nullptr;
    if (const auto comparison = board_clock(capture)) {
        clock = {{"fast_ppm", comparison->ppm}, {"sd_ppm", comparison->sd_ppm}};
    }
    return {{"schema", "gyrolog-info/1"},
            {"file", path},
            {"board", board},
            {"sensor", sensor},
            {"started", started_utc(capture)},
            {"duration_s", duration_s(capture, link)},
            {"samples", link.samples.good},
            {"samples_missing", link.samples.missing},
            {"stops", stops_json(capture, link)},
            {"board_clock", clock},
            {"host_clock_set_by_s", host_clock_set_by_s(capture)},
            {"marks", marks_json(capture)},
            {"end", name_of(capture.file.blocks.end)},
            {"file_bytes", capture.file.blocks.bytes_total},
            {"program", capture.metadata ? capture.metadata->program : ""}};
}

std::string missing_text(const LinkReport& link) {
    const std::uint64_t dropouts = link.dropouts.size() + link.dropouts_unlisted;
    return dropouts == 0
               ? "no sample"
               : counted(link.samples.missing, "sample").append(" in ").append(counted(dropouts, "dropout"));
}

std::vector<LabelledLine> info_lines(const std::string& path, const LoadedCapture& capture) {
    const LinkReport link = capture.decoder->report();
    const auto& hello = capture.decoder->hello();
    const auto& config = capture.decoder->config();
    std::vector<LabelledLine> lines;
    const auto line = [&](const char* what, const std::string& value) {
        if (!value.empty()) { lines.push_back({what, printable(value)}); }
    };
    if (capture.metadata) {
        const SourceIdentity& source = capture.metadata->source;
        line("board", fmt::format("{}{}{}", source.product.empty() ? source.uri : source.product,
                                  source.serial.empty() ? "" : ", serial ", source.serial));
        line("device", source.uri);
    }
    if (hello) {
        line("firmware", fmt::format("{}, protocol {}.{}", hello->firmware, hello->protocol_major,
                                     hello->protocol_minor));
    }
    if (hello && config) { line("sensor", describe_sensor(*hello, *config)); }
    line("started", started_utc(capture));
    const auto rate_hz = capture.decoder->rate_hz();
    if (rate_hz) {
        line("length", fmt::format("{}, {} at {:.4f} Hz", format_duration(duration_s(capture, link)),
                                   counted(link.samples.good, "sample"), *rate_hz));
    }
    if (const auto estimate = capture.decoder->rate_estimate()) {
        line("rate", fmt::format("{:.6f} ± {:.2g} Hz by the board's clock; the stamps jitter by {:.2g} us",
                                 estimate->rate_hz, estimate->sd_hz, estimate->jitter_s * 1e6));
    }
    if (const auto clock = board_clock(capture)) {
        line("clock", fmt::format("the board's runs {:+.2f} ± {:.2g} ppm against this computer's", clock->ppm,
                                  clock->sd_ppm));
    }
    if (const double set_by_s = host_clock_set_by_s(capture); set_by_s != 0.0) {
        line("", fmt::format("this computer's clock was set by {:+.3f} s meanwhile; no time stamp moved",
                             set_by_s));
    }
    line("missing", missing_text(link));
    if (!link.stops.empty()) { line("pause", stops_text(link.stops.size(), stopped_s(capture, link))); }
    for (const std::string& contradiction : capture.contradictions()) { line("note", contradiction); }
    for (const CaptureMark& mark : capture.marks) { line("mark", mark_text(capture, mark)); }
    line("file",
         fmt::format("{}, {}", format_bytes(capture.file.blocks.bytes_total), end_text(path, capture)));
    if (!hello) { line("note", "no HELLO frame: this capture does not say what it is a capture of"); }
    return lines;
}

std::string info_text(const std::string& path, const LoadedCapture& capture) {
    std::string text = printable(path) + "\n";
    for (const LabelledLine& line : info_lines(path, capture)) {
        // A note of the user keeps its spaces where it fits.
        const std::string whole = fmt::format("  {:<10} {}", line.label, line.text);
        text += width_of(whole) <= terminal_width
                    ? whole + "\n"
                    : wrapped_text(fmt::format("  {:<10} ", line.label), line.text);
    }
    return text;
}

}  // namespace gyrolog
