#include "host/formats/recording_csv.hpp"

#include <memory>
#include <utility>

#include "host/base/printable.hpp"
#include "host/formats/csv_table.hpp"

namespace gyrolog {
namespace {

// The table of a file, and what its columns were understood as.
struct RecordingTable {
    std::shared_ptr<std::vector<UnderstoodColumn>> understood;
    CsvTable table;

    std::vector<RecordingColumn> columns() {
        std::vector<RecordingColumn> columns;
        for (std::size_t c = 0; c < understood->size(); ++c) {
            UnderstoodColumn& column = (*understood)[c];
            CsvTableColumn& read = table.columns()[c];
            if (column.meaning && !read.used) { continue; }
            columns.push_back({std::move(column), std::move(read.values)});
        }
        return columns;
    }

    Result<Recording> recording(std::string name, const CsvReadOptions& options) {
        Result<Recording> made = recording_of(columns(), std::move(name), options);
        if (made.ok() && !table.replaced_names().empty()) {
            made->warnings.insert(made->warnings.begin(),
                                  "names replaced by --columns: " + some_names(table.replaced_names()));
        }
        return made;
    }
};

void use(CsvTableColumn& column, const UnderstoodColumn& understood, const CsvReadOptions& options) {
    if (!understood.meaning) { return; }
    const CsvColumn& meaning = *understood.meaning;
    column.used = options.with_accelerometer || meaning.kind != CsvColumn::Kind::force;
    if (meaning.is_gyro()) {
        column.lowest = -rate_most;
        column.highest = rate_most;
        column.needs_half = true;
    }
    if (understood.any_stamp_unit) {
        column.mend_if_word = "leave the column out with --columns " + printable(column.header) +
                              "=_, and give the sampling rate with --rate";
    }
    // Without a given rate an empty time stamp is an error.
    if (!options.rate_hz && meaning.kind == CsvColumn::Kind::time_stamp) {
        column.mend_if_empty = "no time stamp; give the sampling rate with --rate";
    }
}

Result<RecordingTable> recording_table(const CsvReadOptions& options) {
    GYROLOG_TRY(ColumnNames names, parse_column_names(options.choice.columns));
    const std::size_t user_named = names.by_position.size();
    auto understood = std::make_shared<std::vector<UnderstoodColumn>>();
    const auto rule = [understood, options, user_named](std::vector<CsvTableColumn>& columns) -> Status {
        std::vector<std::string> headers;
        headers.reserve(columns.size());
        for (const CsvTableColumn& column : columns) { headers.push_back(column.header); }
        GYROLOG_TRY(*understood, understand_columns(headers, options, user_named));
        for (std::size_t c = 0; c < columns.size(); ++c) { use(columns[c], (*understood)[c], options); }
        return {};
    };
    CsvTableForm form;
    form.example = "t_s,gx_dps,gy_dps,gz_dps";
    form.mend_if_headless = ", or give --columns t,gx,gy,gz and the gyro's --unit";
    form.names = std::move(names.by_position);
    form.lines_per_row = options.samples_per_row;
    return RecordingTable{understood, CsvTable(std::move(form), rule)};
}

Result<Recording> read_file(const std::string& path, const CsvReadOptions& options) {
    GYROLOG_TRY(RecordingTable table, recording_table(options));
    GYROLOG_CHECK(read_csv_file(table.table, path, options.rows_most + 1));
    return table.recording(path.substr(path.find_last_of('/') + 1), options);
}

}  // namespace

Result<Recording> read_recording_csv(const std::string& path, const CsvReadOptions& options) {
    Result<Recording> recording = read_file(path, options);
    if (!recording.ok()) { return in_context("read '" + path + "'", std::move(recording).error()); }
    return recording;
}

Result<Recording> parse_recording_csv(std::string_view text, std::string name,
                                      const CsvReadOptions& options) {
    GYROLOG_TRY(RecordingTable table, recording_table(options));
    GYROLOG_CHECK(table.table.feed(text));
    GYROLOG_CHECK(table.table.finish());
    return table.recording(std::move(name), options);
}

}  // namespace gyrolog
