#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/noise/noise_model.hpp"
#include "host/formats/csv_column.hpp"
#include "host/formats/recording_csv.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 16;

constexpr int decimals_max = 17;

// How one column stands in the text: its name with a unit, and its numbers' relation to the column's data.
struct OutputColumn {
    const Column* column;
    std::string header;
    bool as_source;  // the data as they are
    double per_si;   // else: numbers per SI unit

    double number(std::size_t i) const {
        if (as_source) {
            return std::visit([&](const auto& data) { return static_cast<double>(data[i]); }, column->data);
        }
        return column->value(i) * per_si;
    }
};

OutputColumn output_column(const Column& column, const CsvWriteOptions& options) {
    const bool is_rate = column.unit == "rad/s";
    if (is_rate) {
        std::string unit = options.rate_unit.empty() ? column.source_unit : options.rate_unit;
        if (unit != "dps" && unit != "rad_s") { unit = "dps"; }
        return {&column, column.name + "_" + unit, unit == column.source_unit,
                unit == "dps" ? deg_per_rad : 1.0};
    }
    if (!column.source_unit.empty() && column.source_unit != "lsb") {
        return {&column, column.name + "_" + column.source_unit, true, 1.0};
    }
    if (column.unit == "m/s^2") { return {&column, column.name + "_m_s2", false, 1.0}; }
    if (column.unit == "degC") { return {&column, column.name + "_C", false, 1.0}; }
    if (column.unit == "lsb") { return {&column, column.name + "_lsb", true, 1.0}; }
    return {&column, column.name, false, 1.0};
}

void append_exact(std::string& text, double number) {
    if (std::isnan(number)) { return; }
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text.append(digits.data(), end);
}

void append_nine_digits(std::string& text, double number) {
    if (std::isnan(number)) { return; }
    std::array<char, 32> digits{};
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, 9)
            .ptr;
    text.append(digits.data(), end);
}

// With a fixed number of decimals, by whole-number arithmetic: several times as fast as to_chars.
class FixedPoint {
public:
    // Enough decimals for a thousandth of `step`.
    explicit FixedPoint(double step) {
        double unit = 1.0;
        while (decimals_ < decimals_max && unit > step / 1000.0) {
            ++decimals_;
            unit /= 10.0;
            per_unit_ *= 10.0;
        }
    }

    void append(std::string& text, double number) const {
        constexpr double exact_below = 1e15;
        const double scaled = std::floor(std::fabs(number) * per_unit_ + 0.5);
        if (!(scaled < exact_below)) {
            append_exact(text, number);
            return;
        }
        auto rest = static_cast<std::uint64_t>(scaled);
        std::array<char, 32> digits;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        char* begin = digits.data() + digits.size();
        for (int place = 0; place < decimals_ || rest != 0 || place == decimals_; ++place) {
            if (place == decimals_ && decimals_ != 0) { *--begin = '.'; }
            *--begin = static_cast<char>('0' + rest % 10U);
            rest /= 10U;
        }
        if (number < 0.0 && scaled != 0.0) { *--begin = '-'; }
        text.append(begin, digits.data() + digits.size());
    }

private:
    int decimals_ = 0;
    double per_unit_ = 1.0;
};

// Writes one column's numbers.
class Formatter {
public:
    Formatter(OutputColumn column, bool exact) : column_(std::move(column)), exact_(exact) {
        if (exact_) { return; }
        constexpr double thermometer_step_C = 0.1;
        if (column_.column->is_counts()) {
            fixed_.emplace(column_.column->scale * column_.per_si);
        } else if (column_.column->unit == "degC") {
            fixed_.emplace(thermometer_step_C);
        }
    }

    const std::string& header() const { return column_.header; }
    void append(std::string& text, std::size_t row) const {
        const double number = column_.number(row);
        if (exact_) {
            append_exact(text, number);
        } else if (fixed_) {
            fixed_->append(text, number);
        } else {
            append_nine_digits(text, number);
        }
    }

private:
    OutputColumn column_;
    bool exact_;
    std::optional<FixedPoint> fixed_;
};

// Without an exponent, where a time stamp can be.
void append_stamp(std::string& text, double t_s) {
    constexpr double fixed_below_s = 1e12;
    if (!(std::fabs(t_s) < fixed_below_s && (std::fabs(t_s) >= 1e-9 || t_s == 0.0))) {
        append_exact(text, t_s);
        return;
    }
    std::array<char, 64> digits;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), t_s, std::chars_format::fixed).ptr;
    text.append(digits.data(), end);
}

std::vector<Formatter> formatters_of(const Recording& piece, const CsvWriteOptions& options) {
    std::vector<Formatter> columns;
    columns.reserve(piece.columns.size());
    for (const Column& column : piece.columns) {
        const bool exact = std::ranges::count(options.resolved, column.name) == 0;
        columns.emplace_back(output_column(column, options), exact);
    }
    return columns;
}

double stamp_s(const Recording& piece, std::size_t row, std::int64_t index) {
    return piece.t_s.empty() ? static_cast<double>(index) / piece.rate_hz : piece.t_s[row];
}

void append_row(std::string& text, double t_s, std::size_t row, const std::vector<Formatter>& columns) {
    append_stamp(text, t_s);
    for (const Formatter& column : columns) {
        text += ',';
        column.append(text, row);
    }
}

// For how long the board was stopped before each segment. Both lists are in order of time.
std::vector<double> stops_before_segments(const Recording& recording) {
    std::vector<double> stopped_s(recording.segments.size(), 0.0);
    const double instants_per_s = recording.rate_hz * static_cast<double>(recording.samples_per_row);
    std::size_t behind = 0;
    for (const Dropout& hole : recording.dropouts) {
        const std::int64_t at =
            recording.segments.front().first_index + std::llround(hole.at_s * recording.rate_hz);
        while (behind < stopped_s.size() && recording.segments[behind].first_index <= at) { ++behind; }
        if (behind == stopped_s.size()) { break; }
        if (hole.cause == stopped_cause) {
            stopped_s[behind] += static_cast<double>(hole.samples) / instants_per_s;
        }
    }
    return stopped_s;
}

}  // namespace

double csv_row_bytes(const Recording& piece, const CsvWriteOptions& options) {
    const std::vector<Formatter> columns = formatters_of(piece, options);
    constexpr double line_end_bytes = 1.0;
    double bytes = 0.0;
    std::string text;
    for (const Segment& segment : piece.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const std::size_t row = segment.first + i;
            text.clear();
            append_row(text, stamp_s(piece, row, segment.first_index + static_cast<std::int64_t>(i)), row,
                       columns);
            bytes += static_cast<double>(text.size()) + line_end_bytes;
        }
    }
    return piece.rows() == 0 ? 0.0 : bytes / static_cast<double>(piece.rows());
}

Result<RecordingCsvWriter> RecordingCsvWriter::create(const std::string& path, CsvWriteOptions options) {
    auto file = TextWriter::create(path, options.growth);
    if (!file.ok()) { return in_context("write '" + path + "'", std::move(file).error()); }
    return RecordingCsvWriter(path, std::move(options), std::move(file).value());
}

Status RecordingCsvWriter::append(const Recording& piece) {
    const std::vector<Formatter> columns = formatters_of(piece, options_);
    if (!headed_) {
        text_ = "t_s";
        for (const Formatter& column : columns) { text_ += "," + column.header(); }
        tells_stops_ = piece.stops().events > 0;
        if (tells_stops_) { text_.append(",").append(stopped_column); }
        text_ += '\n';
        headed_ = true;
    }
    const std::vector<double> stopped_s = stops_before_segments(piece);
    for (std::size_t s = 0; s < piece.segments.size(); ++s) {
        const Segment& segment = piece.segments[s];
        for (std::size_t i = 0; i < segment.count; ++i) {
            const std::size_t row = segment.first + i;
            const std::int64_t index = segment.first_index + static_cast<std::int64_t>(i);
            append_row(text_, stamp_s(piece, row, index), row, columns);
            if (tells_stops_) {
                text_ += ',';
                append_exact(text_, i == 0 ? stopped_s[s] : 0.0);
            }
            text_ += '\n';
            if (text_.size() < piece_bytes) { continue; }
            Status written = file_.write(text_);
            if (!written.ok()) { return in_context("write '" + path_ + "'", std::move(written).error()); }
            text_.clear();
        }
    }
    return {};
}

Status RecordingCsvWriter::flush() {
    Status written = file_.write(text_);
    text_.clear();
    if (!written.ok()) { return in_context("write '" + path_ + "'", std::move(written).error()); }
    return {};
}

Status RecordingCsvWriter::close() {
    GYROLOG_CHECK(flush());
    Status closed = file_.close();
    if (!closed.ok()) { return in_context("write '" + path_ + "'", std::move(closed).error()); }
    return {};
}

Status write_recording_csv(const Recording& recording, const std::string& path,
                           const CsvWriteOptions& options) {
    GYROLOG_TRY(RecordingCsvWriter writer, RecordingCsvWriter::create(path, options));
    GYROLOG_CHECK(writer.append(recording));
    return writer.close();
}

}  // namespace gyrolog
