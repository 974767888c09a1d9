#include "host/app/part_choice.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "host/app/denoise_knowledge.hpp"

namespace gyrolog {

Result<TimeSpan> chosen_span(const Recording& recording, const PartChoice& part, const std::string& path) {
    if (part.from_s && part.to_s && *part.from_s >= *part.to_s) {
        return invalid_argument(
            fmt::format("--from {:.6g} s is not before --to {:.6g} s", *part.from_s, *part.to_s));
    }
    const double duration_s = recording.segments.empty() ? 0.0 : recording.duration_s();
    TimeSpan span{part.from_s.value_or(0.0), std::min(part.to_s.value_or(duration_s), duration_s)};
    std::size_t samples = 0;
    for (const Segment& segment : segments_within(recording.segments, recording.rate_hz, span)) {
        samples += segment.count;
    }
    if (samples < 2) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("'{}' has {} sample from {:.6g} s to {:.6g} s; it lasts {:.6g} s", path,
                                 samples == 0 ? "no" : "only one", span.from_s,
                                 part.to_s.value_or(duration_s), duration_s)};
    }
    if (!part.is_still) { return span; }
    const TimeSpan still = still_part_of(part_of(recording, span));
    if (!(still.to_s > still.from_s)) {
        return Error{
            ErrorCode::failed,
            fmt::format("'{}' has no part of a few seconds in which nothing turns, for --still", path)};
    }
    return TimeSpan{span.from_s + still.from_s, span.from_s + still.to_s};
}

Result<Recording> take_part(Recording recording, const PartChoice& choice, const std::string& path) {
    if (choice.is_whole()) { return recording; }
    GYROLOG_TRY(const TimeSpan span, chosen_span(recording, choice, path));
    Recording part = part_of(recording, span);
    part.warnings.push_back(
        fmt::format("this is the part from {:.6g} s to {:.6g} s of {:.6g} s; times count from its start",
                    span.from_s, span.to_s, recording.duration_s()));
    return part;
}

}  // namespace gyrolog
