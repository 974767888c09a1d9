#include "host/fleet/fleet_table.hpp"

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "host/fleet/fleet_recording.hpp"
#include "host/fleet/fleet_sqlite.hpp"
#include "tests/host/fleet/made_lines.hpp"
#include "tests/support/program.hpp"

namespace gyrolog {
namespace {

using testing::ElementsAre;

FleetRecordings joined(const std::vector<nlohmann::json>& lines,
                       const std::vector<std::string>& expected = {}) {
    std::vector<FleetLine> read;
    for (const nlohmann::json& line : lines) { read.push_back(parsed(line)); }
    return join_lines(read, expected, [](int a, int b) { return std::max(a, b); });
}

FleetTable table_of(const FleetRecordings& of, Sensors sensors = Sensors::gyro) {
    return fleet_table(of.recordings, {}, sensors);
}

std::string shown(const FleetTable& table, std::size_t row, const std::string& column) {
    const auto found =
        std::ranges::find_if(table.columns, [&](const TableColumn& one) { return column == one.name; });
    if (found == table.columns.end()) { return "there is no column " + column; }
    FleetTable one;
    one.columns = {*found};
    one.rows = {{table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()))}};
    const std::string csv = as_csv(one);
    const std::size_t begin = csv.find('\n') + 1;
    return csv.substr(begin, csv.size() - begin - 1);
}

TEST(FleetTable, JoinsTheLinesOfOneFile) {
    nlohmann::json diagnosis = diagnosis_of("./a.csv");
    diagnosis["exit"] = 5;
    const FleetRecordings of = joined({analysis_of({}), diagnosis, analysis_of({.file = "b.csv"})});
    ASSERT_EQ(of.recordings.size(), 2U);
    const FleetTable table = table_of(of);
    ASSERT_EQ(table.rows.size(), 6U);
    EXPECT_EQ(shown(table, 0, "file"), "a.csv");
    EXPECT_EQ(shown(table, 0, "axis"), "x");
    EXPECT_EQ(shown(table, 0, "N"), "0.005");
    EXPECT_EQ(shown(table, 0, "K"), "");
    EXPECT_EQ(shown(table, 0, "K_upper"), "0.0001");
    EXPECT_EQ(shown(table, 0, "rate_hz"), "100") << "of the analysis";
    EXPECT_EQ(shown(table, 0, "verdict"), "partly");
    EXPECT_EQ(shown(table, 0, "causes"), "tone=0.62;rtn=0.1");
    EXPECT_EQ(shown(table, 1, "causes"), "") << "y has none";
    EXPECT_EQ(shown(table, 2, "causes"), "rtn=0.1");
    EXPECT_EQ(shown(table, 0, "gap_before"), "7.9");
    EXPECT_EQ(shown(table, 0, "gap_after"), "");
    EXPECT_EQ(shown(table, 0, "exit"), "5");
    EXPECT_EQ(shown(table, 0, "seconds"), "11.5");
    EXPECT_EQ(shown(table, 0, "seed"), "7");
    EXPECT_EQ(shown(table, 0, "temperature_C"), "31.5");
    EXPECT_EQ(shown(table, 3, "verdict"), "");
}

TEST(FleetTable, WhatWasDoneAgainCounts) {
    const FleetRecordings of =
        joined({{{"file", "a.csv"}, {"command", "analyze"}, {"exit", 1}, {"error", "torn"}},
                analysis_of({.N = 0.006})});
    const FleetTable table = table_of(of);
    ASSERT_EQ(table.rows.size(), 3U);
    EXPECT_EQ(shown(table, 0, "error"), "");
    EXPECT_EQ(shown(table, 0, "exit"), "0");
    EXPECT_EQ(shown(table, 0, "N"), "0.006");
}

TEST(FleetTable, ARecordingThatFailedIsARowWithItsError) {
    const FleetTable table =
        table_of(joined({{{"file", "torn.pcapng"}, {"exit", 1}, {"error", "there are no samples, \"none\""}},
                         analysis_of({})}));
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(shown(table, 0, "file"), "torn.pcapng");
    EXPECT_EQ(shown(table, 0, "axis"), "");
    EXPECT_EQ(shown(table, 0, "exit"), "1");
    EXPECT_EQ(shown(table, 0, "error"), "\"there are no samples, \"\"none\"\"\"");
}

TEST(FleetTable, WhatWasExpectedAndDidNotComeIsARow) {
    const FleetRecordings of = joined({analysis_of({.file = "day/a.csv"}), analysis_of({.file = "b.csv"})},
                                      {"a.csv", "./b.csv", "c.csv", "night/a.csv", "c.csv"});
    EXPECT_THAT(of.unanswered, ElementsAre("c.csv", "night/a.csv"));
    const FleetTable table = table_of(of);
    ASSERT_EQ(table.rows.size(), 8U);
    EXPECT_EQ(shown(table, 6, "file"), "c.csv");
    EXPECT_EQ(shown(table, 6, "error"), "no answer");
    EXPECT_EQ(shown(table, 6, "exit"), "");
}

// In every cell of text, from a line as from a list of names.
TEST(FleetTable, ANameFromOutsideCommandsNoTerminal) {
    nlohmann::json line = analysis_of({.file = "a\x1b[2J.csv"});
    line["recording"]["board"] = "S1\nb.csv,,";
    const FleetRecordings of =
        joined({line, {{"file", "b.csv"}, {"exit", 1}, {"error", "\x1b]0;x\x07"}}}, {"c\x1b[31m.csv\xFF"});
    const FleetTable table = table_of(of);
    EXPECT_EQ(shown(table, 0, "file"), "a\\u001b[2J.csv");
    EXPECT_EQ(shown(table, 0, "board"), "\"S1\\u000ab.csv,,\"");
    EXPECT_EQ(shown(table, 3, "error"), "\\u001b]0;x\\u0007");
    EXPECT_EQ(shown(table, 4, "file"), "c\\u001b[31m.csv\\xff");
}

TEST(FleetTable, AnAccelerometerHasRowsOnRequest) {
    nlohmann::json line = analysis_of({});
    line["accelerometer"]["axes"]["x"] = {
        {"mean", {{"value", 1.0}, {"unit", "g"}}},
        {"coefficients", {{"N", {{"state", "identified"}, {"value", 1e-4}, {"sd", 1e-6}}}}}};
    EXPECT_EQ(table_of(joined({line})).rows.size(), 3U);
    const FleetTable all = table_of(joined({line}), Sensors::all);
    ASSERT_EQ(all.rows.size(), 4U);
    EXPECT_EQ(shown(all, 3, "sensor"), "accelerometer");
    EXPECT_EQ(shown(all, 3, "unit"), "g");
    EXPECT_EQ(shown(all, 3, "bias"), "") << "gravity is in the mean";
    EXPECT_EQ(shown(all, 3, "N"), "0.0001");
}

// What SQLite holds, as the same text.
std::string csv_of_sqlite(const FleetTable& table, const std::string& path) {
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    sqlite3_stmt* rows = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(database, "SELECT * FROM recordings ORDER BY rowid", -1, &rows, nullptr),
              SQLITE_OK);
    FleetTable read;
    for (int i = 0; i < sqlite3_column_count(rows); ++i) {
        const std::string name = sqlite3_column_name(rows, i);
        for (const TableColumn& column : table.columns) {
            if (name == column.name) { read.columns.push_back(column); }
        }
    }
    while (sqlite3_step(rows) == SQLITE_ROW) {
        std::vector<Cell>& row = read.rows.emplace_back();
        for (int i = 0; i < sqlite3_column_count(rows); ++i) {
            switch (sqlite3_column_type(rows, i)) {
                case SQLITE_TEXT:
                    row.emplace_back(reinterpret_cast<const char*>(sqlite3_column_text(rows, i)));
                    break;
                case SQLITE_INTEGER:
                    row.emplace_back(std::int64_t{sqlite3_column_int64(rows, i)});
                    break;
                case SQLITE_FLOAT:
                    row.emplace_back(sqlite3_column_double(rows, i));
                    break;
                default:
                    row.emplace_back();
            }
        }
    }
    sqlite3_finalize(rows);
    sqlite3_close(database);
    return as_csv(read);
}

TEST(FleetTable, SqliteHoldsWhatCsvHolds) {
    const TemporaryFolder folder;
    const std::string path = folder.path("table.sqlite");
    std::ofstream(path) << "what was there";
    const FleetTable table =
        table_of(joined({analysis_of({.bias = 1.0 / 3.0}),
                         diagnosis_of("a.csv"),
                         {{"file", "b,\"\xC3\xA4\".csv"}, {"exit", 6}, {"error", "disk\nfull"}}},
                        {"c.csv"}));
    ASSERT_TRUE(write_sqlite(table, path).ok());
    EXPECT_EQ(csv_of_sqlite(table, path), as_csv(table));
    EXPECT_EQ(table.rows.size(), 5U);
}

TEST(FleetTable, SqliteThatCannotBeWrittenLeavesWhatWasThere) {
    const TemporaryFolder folder;
    const Status written =
        write_sqlite(table_of(joined({analysis_of({})})), folder.path("none/table.sqlite"));
    ASSERT_FALSE(written.ok());
    EXPECT_EQ(written.error().code, ErrorCode::not_found);
    EXPECT_FALSE(write_sqlite(table_of(joined({analysis_of({})})), "/dev/null").ok());
}

}  // namespace
}  // namespace gyrolog
