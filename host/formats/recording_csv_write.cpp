#include <array>
#include <charconv>
#include <cmath>

#include "analysis/noise/noise_model.hpp"
#include "host/formats/recording_csv.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 16;

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

void append(std::string& text, double number) {
    if (std::isnan(number)) { return; }
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text.append(digits.data(), end);
}

Status write_rows(const Recording& recording, const std::vector<OutputColumn>& columns, TextWriter& file) {
    std::string text = "t_s";
    for (const OutputColumn& column : columns) { text += "," + column.header; }
    text += '\n';
    for (const Segment& segment : recording.segments) {
        for (std::size_t i = 0; i < segment.count; ++i) {
            const std::size_t row = segment.first + i;
            const auto index = static_cast<double>(segment.first_index + static_cast<std::int64_t>(i));
            append(text, recording.t_s.empty() ? index / recording.rate_hz : recording.t_s[row]);
            for (const OutputColumn& column : columns) {
                text += ',';
                append(text, column.number(row));
            }
            text += '\n';
            if (text.size() >= piece_bytes) {
                GYROLOG_CHECK(file.write(text));
                text.clear();
            }
        }
    }
    return file.write(text);
}

Status write_file(const Recording& recording, const std::string& path, const CsvWriteOptions& options) {
    std::vector<OutputColumn> columns;
    for (const Column& column : recording.columns) { columns.push_back(output_column(column, options)); }
    GYROLOG_TRY(TextWriter file, TextWriter::create(path));
    GYROLOG_CHECK(write_rows(recording, columns, file));
    return file.close();
}

}  // namespace

Status write_recording_csv(const Recording& recording, const std::string& path,
                           const CsvWriteOptions& options) {
    Status status = write_file(recording, path, options);
    if (!status.ok()) { return in_context("write '" + path + "'", std::move(status).error()); }
    return status;
}

}  // namespace gyrolog
