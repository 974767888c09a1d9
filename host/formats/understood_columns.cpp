#include "host/formats/understood_columns.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/formats/column_dialect.hpp"
#include "host/formats/separated_fields.hpp"

namespace gyrolog {
namespace {

using Kind = CsvColumn::Kind;

bool is_no_column(std::string_view name) { return name == "_" || name == "-"; }

bool is_sensor(const std::optional<CsvColumn>& meaning) {
    return meaning && (meaning->is_gyro() || meaning->kind == Kind::force);
}

constexpr const char* sensor_names = "such as t_s,gx_dps,gy_dps,gz_dps (or _rad_s, _deg_h, _lsb, _deg, _rad)";

// Understands the columns of one file.
class Reading {
public:
    Reading(std::span<const std::string> headers, const ColumnChoice& choice, const WantedColumns& wanted,
            std::size_t user_named)
        : headers_(headers), choice_(choice), wanted_(wanted), user_named_(user_named) {}

    Result<std::vector<UnderstoodColumn>> read() {
        GYROLOG_TRY(names_, parse_column_names(choice_.columns));
        if (user_named_ > 0) { names_.by_name.clear(); }
        GYROLOG_CHECK(check_names());
        const bool is_canonical = user_named_ == 0 && names_.by_name.empty() &&
                                  std::ranges::any_of(headers_, [](const auto& header) {
                                      const auto meaning = csv_column(header);
                                      return meaning && meaning->is_gyro();
                                  });
        for (const std::string& header : headers_) {
            GYROLOG_TRY(UnderstoodColumn column, understand(header, is_canonical));
            columns_.push_back(std::move(column));
        }
        if (user_named_ == 0) { let_canonical_names_win(); }
        take_one_time();
        take_one_temperature();
        GYROLOG_CHECK(check_twice());
        GYROLOG_CHECK(check_sensors());
        return std::move(columns_);
    }

private:
    Status check_names() const {
        for (const auto& [name, meaning] : names_.by_name) {
            if (std::ranges::find(headers_, name) == headers_.end()) {
                return invalid_argument("--columns: there is no column " + in_quotes(name) + " among " +
                                        some_names(headers_));
            }
        }
        return {};
    }

    Result<UnderstoodColumn> understand(const std::string& header, bool is_canonical) {
        UnderstoodColumn column{header, {}};
        const bool is_beyond = user_named_ > 0 && columns_.size() >= user_named_;
        ranks_.push_back(0);
        if (is_beyond) { return column; }
        const auto renamed = names_.by_name.find(header);
        const bool of_user = user_named_ > 0 || renamed != names_.by_name.end();
        const std::string& name = renamed == names_.by_name.end() ? header : renamed->second;
        if (of_user && is_no_column(name)) {
            column.is_left_out = true;
            return column;
        }
        column.meaning = csv_column(name);
        if (column.meaning) {
            if (name != header) { column.taken_for = name; }
            return column;
        }
        const auto told = dialect_name(name);
        if (!told) {
            if (!of_user) {
                take_capitals(column);
                return column;
            }
            return invalid_argument(
                "--columns: " + in_quotes(name) +
                " is no name of a column: write t, gx, gy, gz, ax, ay, az, with or without "
                "a unit (t_ms, gx_dps), temp_C, or _ for one to leave out");
        }
        // The time of a file that has a gyro by its own name may be no number where a rate is given.
        if (is_canonical && told->quantity == "t" && wanted_.rate_is_given) { return column; }
        // A word for a gyro without a unit was never meant for us where the gyro has its own name.
        if (is_canonical && told->quantity[0] == 'g' && told->unit.empty() && choice_.gyro_unit.empty()) {
            return column;
        }
        take(column, *told);
        return column;
    }

    // T_S, GX1_DPS: canonical names in capitals, as some loggers and spreadsheets write them.
    void take_capitals(UnderstoodColumn& column) {
        std::string name = column.header;
        std::ranges::transform(name, name.begin(), [](char c) {
            return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        });
        column.meaning = csv_column(name);
        if (!column.meaning) { return; }
        column.taken_for = std::move(name);
        ranks_.back() = 1;
    }

    // Where a quantity has its canonical name, another program's word for it is ignored.
    void let_canonical_names_win() {
        std::set<std::string> canonical;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (columns_[i].meaning && ranks_[i] == 0) { canonical.insert(without_unit_number(i)); }
        }
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const bool is_told = columns_[i].meaning && ranks_[i] > 0;
            const bool is_time = is_told && columns_[i].meaning->kind == Kind::time_stamp;
            if (is_told && !is_time && canonical.contains(without_unit_number(i))) { ignore(columns_[i]); }
        }
    }

    // "gx" of "gx2", an array's second.
    std::string without_unit_number(std::size_t column) const {
        std::string name = columns_[column].meaning->name;
        if (is_sensor(columns_[column].meaning)) { name.resize(2); }
        return name;
    }

    void take(UnderstoodColumn& column, const DialectName& told) {
        std::string unit = told.unit;
        if (unit.empty() && told.quantity[0] == 'g') {
            unit = dialect_unit('g', choice_.gyro_unit).value_or("");
            if (unit.empty()) { gyros_without_unit_.push_back(column.header); }
        } else if (unit.empty() && told.quantity[0] == 'a') {
            unit = dialect_unit('a', choice_.accelerometer_unit).value_or("");
            column.lacks_unit = unit.empty();
            if (unit.empty()) { accelerometers_without_unit_.push_back(column.header); }
        } else if (unit.empty() && told.quantity == "t") {
            column.any_stamp_unit = true;
            unit = "s";
        }
        if (unit.empty()) { return; }
        column.taken_for = told.quantity + "_" + unit;
        column.meaning = csv_column(column.taken_for);
        ranks_.back() = told.rank + 1;
    }

    void ignore(UnderstoodColumn& column) {
        column.meaning.reset();
        column.taken_for.clear();
        column.any_stamp_unit = false;
    }

    // t_s before t_ms and its like, and those before what dialects have.
    void take_one_time() {
        UnderstoodColumn* taken = nullptr;
        std::size_t least = 0;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            UnderstoodColumn& column = columns_[i];
            if (!column.meaning || column.meaning->kind != Kind::time_stamp) { continue; }
            const std::size_t rank = 2 * ranks_[i] + (column.meaning->per_s != 1.0 ? 1 : 0);
            if (taken == nullptr || rank < least) {
                if (taken != nullptr) { ignore(*taken); }
                taken = &column;
                least = rank;
            } else {
                ignore(column);
            }
        }
    }

    void take_one_temperature() {
        const UnderstoodColumn* taken = nullptr;
        for (UnderstoodColumn& column : columns_) {
            if (!column.meaning || column.meaning->kind != Kind::temperature) { continue; }
            if (taken == nullptr) {
                taken = &column;
            } else {
                ignore(column);
            }
        }
    }

    Status check_twice() const {
        std::map<std::string, const UnderstoodColumn*> seen;
        for (const UnderstoodColumn& column : columns_) {
            if (!column.meaning || (column.meaning->kind == Kind::force && !wanted_.with_accelerometer)) {
                continue;
            }
            const auto [first, is_new] = seen.emplace(column.meaning->name, &column);
            if (is_new) { continue; }
            const std::string both = "columns " + in_quotes(first->second->header) + " and " +
                                     in_quotes(column.header) + " are both " + column.meaning->name;
            if (user_named_ > 0) { return invalid_argument(both + ": write _ in --columns for one of them"); }
            return malformed(both + ": leave one out with --columns " + printable(column.header) + "=_");
        }
        return {};
    }

    Status check_sensors() const {
        if (!gyros_without_unit_.empty()) {
            return invalid_argument("no unit in the name of " + some_names(gyros_without_unit_) +
                                    ": give it with --unit (deg/s, rad/s, deg/h or lsb)");
        }
        for (const UnderstoodColumn& column : columns_) {
            const bool is_force = column.meaning && column.meaning->kind == Kind::force;
            const bool counts = !is_force || (!wanted_.needs_gyro && wanted_.with_accelerometer);
            if (is_sensor(column.meaning) && counts) { return {}; }
        }
        if (!wanted_.needs_gyro && !accelerometers_without_unit_.empty()) {
            return invalid_argument("no unit in the name of " + some_names(accelerometers_without_unit_) +
                                    ": give it with --acc-unit (g, m/s^2 or lsb)");
        }
        const std::string or_accelerometer = wanted_.needs_gyro ? "" : " and none of an accelerometer";
        return malformed(
            "no gyro column" + or_accelerometer + ", but " + some_names(headers_) +
            ": name columns by --columns (NAME=gx_dps, or t,gx,gy,gz by position) and their unit "
            "by --unit, or in the file, " +
            sensor_names);
    }

    std::span<const std::string> headers_;
    const ColumnChoice& choice_;
    const WantedColumns& wanted_;
    std::size_t user_named_;  // of the first columns
    ColumnNames names_;
    std::vector<UnderstoodColumn> columns_;
    std::vector<std::size_t> ranks_;  // 0: canonical
    std::vector<std::string> gyros_without_unit_;
    std::vector<std::string> accelerometers_without_unit_;
};

}  // namespace

Result<ColumnNames> parse_column_names(const std::string& columns) {
    ColumnNames names;
    if (columns.empty()) { return names; }
    std::string_view rest = columns;
    while (true) {
        const std::size_t comma = rest.find(',');
        const std::string_view item = trimmed(rest.substr(0, comma));
        const std::size_t equals = item.rfind('=');
        if (item.empty()) {
            return invalid_argument("--columns " + in_quotes(columns) +
                                    ": a name is empty; write _ for a column to leave out");
        }
        if (equals == std::string::npos) {
            names.by_position.emplace_back(item);
        } else {
            std::string name(trimmed(item.substr(0, equals)));
            if (!names.by_name.emplace(name, trimmed(item.substr(equals + 1))).second) {
                return invalid_argument("--columns " + in_quotes(columns) + ": " + in_quotes(name) +
                                        " is named twice");
            }
        }
        if (comma == std::string_view::npos) { break; }
        rest.remove_prefix(comma + 1);
    }
    if (!names.by_name.empty() && !names.by_position.empty()) {
        return invalid_argument("--columns " + in_quotes(columns) +
                                ": write names by position (t,gx,gy,gz) or NAME=gx_dps for each, not both");
    }
    return names;
}

Status check_column_choice(const ColumnChoice& choice) {
    const auto names = parse_column_names(choice.columns);
    if (!names.ok()) { return names.error(); }
    if (!choice.gyro_unit.empty() && !dialect_unit('g', choice.gyro_unit)) {
        return invalid_argument(in_quotes(choice.gyro_unit) +
                                " is no unit of a gyro: write deg/s, rad/s, deg/h or lsb");
    }
    if (!choice.accelerometer_unit.empty() && !dialect_unit('a', choice.accelerometer_unit)) {
        return invalid_argument(in_quotes(choice.accelerometer_unit) +
                                " is no unit of an accelerometer: write g, m/s^2 or lsb");
    }
    return {};
}

Result<std::vector<UnderstoodColumn>> understand_columns(std::span<const std::string> headers,
                                                         const ColumnChoice& choice,
                                                         const WantedColumns& wanted,
                                                         std::size_t user_named) {
    return Reading(headers, choice, wanted, user_named).read();
}

std::string some_names(std::span<const std::string> names) {
    constexpr std::size_t names_most = 10;
    constexpr std::size_t bytes_most = 160;
    std::string text;
    std::size_t told = 0;
    for (; told < names.size() && told < names_most; ++told) {
        const std::string name = in_quotes(names[told]);
        if (told > 0 && text.size() + name.size() > bytes_most) { break; }
        text += (told > 0 ? ", " : "") + name.substr(1, name.size() - 2);
    }
    if (told < names.size()) { text += fmt::format(" and {} more", names.size() - told); }
    return text;
}

}  // namespace gyrolog
