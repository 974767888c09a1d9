#include "host/app/diagnosis_input.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/diagnose/likelihood/prediction.hpp"
#include "analysis/diagnose/multiscale/long_diagnosis.hpp"
#include "analysis/simulate/known_motion.hpp"
#include "host/app/quantity.hpp"
#include "host/base/counted.hpp"

namespace gyrolog {
namespace {

constexpr double row_of_means_s = 0.1;
// As far as one sensor's clock may stray.
constexpr double same_rate_rel = 0.03;

// The most of one row that still leaves enough rows for a diagnosis.
std::string longest_average(std::size_t samples) {
    const std::size_t most = samples / resolution::diagnosable_samples_min;
    return most == 0 ? fmt::format("a diagnosis needs {} at least", resolution::diagnosable_samples_min)
                     : fmt::format("`--average {}` is the most that it can be looked at with", most);
}

std::optional<Error> refused(const Recording& recording, const std::string& path) {
    const auto refusal = diagnosis_refusal(recording);
    if (!refusal) { return std::nullopt; }
    const std::size_t samples = recording.samples_per_row;
    const std::string as = samples > 1 ? fmt::format(": in means of {} samples it", samples) : "";
    const bool averaged_away = samples > 1 && recording.rows() < resolution::diagnosable_samples_min;
    const std::string advice = averaged_away ? "; " + longest_average(recording.rows() * samples) : "";
    return Error{ErrorCode::failed, fmt::format("'{}'{} {}{}", path, as, *refusal, advice)};
}

// Sampling instants, whether or not a sample is there.
std::size_t slots(const Recording& recording) {
    return recording.rows() + static_cast<std::size_t>(recording.missing_samples());
}

Recording first_slots(Recording recording, std::size_t most) {
    if (slots(recording) <= most) { return recording; }
    const std::int64_t end = recording.segments.front().first_index + static_cast<std::int64_t>(most);
    std::size_t rows = 0;
    for (const Segment& segment : recording.segments) {
        const std::int64_t within = end - segment.first_index;
        if (within > 0) { rows += std::min(segment.count, static_cast<std::size_t>(within)); }
    }
    return first_rows(std::move(recording), rows);
}

std::string beginning_warning(const Recording& beginning, const std::string& path, const std::string& why) {
    return fmt::format("'{}' is looked at from its beginning to {}: {}", path,
                       format_duration(beginning.duration_s()), why);
}

std::string most_warning(const Recording& beginning, const std::string& path, std::size_t most) {
    const std::size_t samples = beginning.samples_per_row;
    return beginning_warning(
        beginning, path,
        samples == 1
            ? fmt::format("a diagnosis takes no more than {} samples of it", most)
            : fmt::format(
                  "a diagnosis takes no more than {} means; `--average {}` looks at ten times as much", most,
                  10 * samples));
}

// A recording that is shorter than one row of means is none: then the reader says that it has no samples.
Error not_read(const RecordingInput& means, Error error) {
    if (means.samples_per_row == 1 || error.code != ErrorCode::malformed) { return error; }
    RecordingInput input = means;
    input.samples_per_row = 1;
    input.samples_most = means.samples_per_row;
    const auto samples = read_recording(input);
    if (!samples.ok() || samples->rows() == 0) { return error; }
    const std::size_t rows = samples->rows();
    if (rows >= means.samples_per_row) {
        return Error{ErrorCode::failed,
                     fmt::format("'{}' has nowhere {} samples without one that is missing, as --average asks "
                                 "for",
                                 means.path, means.samples_per_row)};
    }
    return Error{ErrorCode::failed,
                 fmt::format("`--average {}` is longer than '{}', which has {}; {}", means.samples_per_row,
                             means.path, counted(rows, "sample"), longest_average(rows))};
}

struct Read {
    Recording samples;
    bool is_long = false;  // there are more than these
};

Result<Read> read_samples(RecordingInput input, std::size_t most) {
    input.samples_most = (most + 1) * input.samples_per_row;
    Result<Recording> samples = read_recording(input);
    if (!samples.ok()) { return not_read(input, std::move(samples).error()); }
    Read read{std::move(samples).value()};
    read.is_long = slots(read.samples) > most;
    if (read.is_long) { read.samples = first_slots(std::move(read.samples), most); }
    if (auto refusal = refused(read.samples, input.path)) {
        if (input.sensor == SensorKind::accelerometer && has_reference(read.samples)) {
            refusal->message += "; " + read.samples.warnings.back();
        }
        return *std::move(refusal);
    }
    read.samples = with_known_motion(std::move(read.samples));
    if (auto refusal = refused(read.samples, input.path)) {
        refusal->message += "; " + read.samples.warnings.back();
        return *std::move(refusal);
    }
    return read;
}

std::shared_ptr<const Recording> shared(Recording recording) {
    return std::make_shared<const Recording>(std::move(recording));
}

// As much as one pass takes; `warnings` are told with it.
Result<DiagnosisInput> read_for_one_pass(const RecordingInput& input,
                                         const std::vector<std::string>& warnings = {}) {
    GYROLOG_TRY(Read read, read_samples(input, resolution::diagnosable_samples_max));
    if (read.is_long) {
        read.samples.warnings.push_back(
            most_warning(read.samples, input.path, resolution::diagnosable_samples_max));
    }
    read.samples.warnings.insert(read.samples.warnings.end(), warnings.begin(), warnings.end());
    return DiagnosisInput{shared(std::move(read.samples)), nullptr};
}

// Why means cannot be held beside the samples of the same file; empty when they can.
std::string unusable(const Recording& means, const Recording& samples, const std::string& path) {
    if (const auto refusal = refused(means, path)) { return refusal->message; }
    const double rate_hz = means.rate_hz * static_cast<double>(means.samples_per_row);
    if (std::abs(rate_hz / samples.rate_hz - 1.0) < same_rate_rel) { return {}; }
    return fmt::format("it begins with {:.6g} Hz, and its longest stretch has {:.6g} Hz", samples.rate_hz,
                       rate_hz);
}

struct Means {
    std::shared_ptr<const Recording> rows;  // null: they cannot be held beside the samples
    std::string why_not;
};

Result<Means> read_means(RecordingInput input, std::size_t samples_per_row, const Recording& samples) {
    input.samples_most = RecordingInput{}.samples_most;
    input.samples_per_row = samples_per_row;
    GYROLOG_TRY(Recording means, read_recording(input));
    if (std::string why = unusable(means, samples, input.path); !why.empty()) {
        return Means{nullptr, std::move(why)};
    }
    return Means{shared(std::move(means)), {}};
}

}  // namespace

Result<DiagnosisInput> read_for_diagnosis(const RecordingInput& whole) {
    GYROLOG_TRY(const RecordingInput input, with_known_part(whole));
    if (input.samples_per_row > 1) { return read_for_one_pass(input); }
    GYROLOG_TRY(Read beginning, read_samples(input, resolution::beginning_max));
    if (!beginning.is_long) { return DiagnosisInput{shared(std::move(beginning.samples)), nullptr}; }
    if (has_reference(beginning.samples)) { return read_for_one_pass(input); }
    const double samples = std::max(2.0, std::round(beginning.samples.rate_hz * row_of_means_s));
    GYROLOG_TRY(Means means, read_means(input, static_cast<std::size_t>(samples), beginning.samples));
    if (means.rows == nullptr) {
        return read_for_one_pass(
            input, {fmt::format("'{}' is looked at sample by sample only: {}", input.path, means.why_not)});
    }
    const std::size_t rows = slots(*means.rows);
    if (rows * means.rows->samples_per_row <= resolution::diagnosable_samples_max) {
        return read_for_one_pass(input);
    }
    if (rows > resolution::means_max) {
        means.rows =
            shared(means_of(*means.rows, (rows + resolution::means_max - 1) / resolution::means_max));
    }
    return DiagnosisInput{shared(std::move(beginning.samples)), std::move(means.rows)};
}

Result<DiagnosisInput> read_for_diagnosis(const RecordingInput& input, const DiagnosisInput& like) {
    if (like.means == nullptr) { return read_for_one_pass(input); }
    GYROLOG_TRY(Read beginning, read_samples(input, resolution::beginning_max));
    GYROLOG_TRY(Means means, read_means(input, like.means->samples_per_row, beginning.samples));
    if (means.rows == nullptr) {
        beginning.samples.warnings.push_back(beginning_warning(beginning.samples, input.path, means.why_not));
    } else if (slots(*means.rows) > resolution::means_max) {
        means.rows = shared(first_slots(*means.rows, resolution::means_max));
        beginning.samples.warnings.push_back(most_warning(*means.rows, input.path, resolution::means_max));
    }
    return DiagnosisInput{shared(std::move(beginning.samples)), std::move(means.rows)};
}

}  // namespace gyrolog
