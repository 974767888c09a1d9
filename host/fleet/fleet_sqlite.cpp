#include "host/fleet/fleet_sqlite.hpp"

#include <filesystem>
#include <memory>

#include <sqlite3.h>

#include "host/base/replacing_file.hpp"

namespace gyrolog {
namespace {

struct CloseDatabase {
    void operator()(sqlite3* database) const { static_cast<void>(sqlite3_close_v2(database)); }
};
struct FinishStatement {
    void operator()(sqlite3_stmt* statement) const { static_cast<void>(sqlite3_finalize(statement)); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, FinishStatement>;

Error error_of(sqlite3* database) {
    const bool is_full = sqlite3_errcode(database) == SQLITE_FULL;
    return {is_full ? ErrorCode::disk_full : ErrorCode::storage_failed, sqlite3_errmsg(database)};
}

Status execute(sqlite3* database, const std::string& sql) {
    if (sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) { return {}; }
    return error_of(database);
}

const char* type_of(CellKind kind) {
    switch (kind) {
        case CellKind::text:
            return "TEXT";
        case CellKind::whole:
            return "INTEGER";
        case CellKind::real:
            break;
    }
    return "REAL";
}

// The columns' names are this program's own: no quotation mark is in them.
std::string column_list(const FleetTable& table, bool with_types) {
    std::string list;
    for (const TableColumn& column : table.columns) {
        list += (list.empty() ? "\"" : ", \"") + std::string(column.name) + '"';
        if (with_types) { list += std::string(" ") + type_of(column.kind); }
    }
    return list;
}

void bind(sqlite3_stmt* statement, int place, const Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) {
        sqlite3_bind_text64(statement, place, text->data(), text->size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    } else if (const auto* whole = std::get_if<std::int64_t>(&cell)) {
        sqlite3_bind_int64(statement, place, *whole);
    } else if (const auto* real = std::get_if<double>(&cell)) {
        sqlite3_bind_double(statement, place, *real);
    } else {
        sqlite3_bind_null(statement, place);
    }
}

Status insert_rows(sqlite3* database, const FleetTable& table) {
    std::string marks;
    for (std::size_t i = 0; i < table.columns.size(); ++i) { marks += i == 0 ? "?" : ", ?"; }
    const std::string sql =
        "INSERT INTO recordings (" + column_list(table, false) + ") VALUES (" + marks + ")";
    sqlite3_stmt* prepared = nullptr;
    if (sqlite3_prepare_v2(database, sql.c_str(), -1, &prepared, nullptr) != SQLITE_OK) {
        return error_of(database);
    }
    const Statement statement(prepared);
    for (const std::vector<Cell>& row : table.rows) {
        for (std::size_t i = 0; i < row.size(); ++i) { bind(prepared, static_cast<int>(i) + 1, row[i]); }
        if (sqlite3_step(prepared) != SQLITE_DONE || sqlite3_reset(prepared) != SQLITE_OK) {
            return error_of(database);
        }
    }
    return {};
}

// Nobody reads it before it is whole, so it needs no journal, and commit() of the file syncs it.
Status fill(const FleetTable& table, const std::string& path) {
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READWRITE, nullptr);
    const Database database(opened);
    if (opened == nullptr) { return Error{ErrorCode::failed, "out of memory"}; }
    if (code != SQLITE_OK) { return error_of(opened); }
    GYROLOG_CHECK(execute(opened, "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN"));
    GYROLOG_CHECK(execute(opened, "CREATE TABLE recordings (" + column_list(table, true) + ")"));
    GYROLOG_CHECK(insert_rows(opened, table));
    return execute(opened, "COMMIT");
}

Status replace(const FleetTable& table, const std::string& path) {
    std::error_code none;
    const auto there = std::filesystem::status(path, none);
    if (std::filesystem::exists(there) && std::filesystem::is_other(there)) {
        return invalid_argument("it is no file, and a database needs one");
    }
    GYROLOG_TRY(ReplacingFile file, ReplacingFile::create(path));
    GYROLOG_CHECK(fill(table, file.written_path()));
    return file.commit();
}

}  // namespace

Status write_sqlite(const FleetTable& table, const std::string& path) {
    const Status done = replace(table, path);
    return done.ok() ? done : in_context("write '" + path + "'", done.error());
}

}  // namespace gyrolog
