#include "host/fleet/fleet_line.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "host/base/printable.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/json.hpp"
#include "host/formats/json_keys.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {
namespace {

// Reads keys that may be absent, or null where a number was not finite.
class LineKeys {
public:
    explicit LineKeys(JsonKeys keys) : keys_(std::move(keys)) {}

    const Json* find(const std::string& key) {
        const Json* found = keys_.find(key);
        return found == nullptr || found->is_null() ? nullptr : found;
    }
    std::string text(const std::string& key) {
        const Json* found = find(key);
        return found == nullptr ? std::string() : keys_.text_in(*found, keys_.name(key));
    }
    std::optional<double> number(const std::string& key) {
        const Json* found = find(key);
        if (found == nullptr) { return std::nullopt; }
        return keys_.number_in(*found, keys_.name(key), JsonKeys::Range::any);
    }
    std::optional<std::uint64_t> count(const std::string& key) {
        const Json* found = find(key);
        if (found == nullptr) { return std::nullopt; }
        if (found->is_number_unsigned()) { return found->get<std::uint64_t>(); }
        keys_.fail(keys_.name(key), "is no whole number");
        return std::nullopt;
    }
    std::vector<std::string> texts(const std::string& key) {
        std::vector<std::string> list;
        each(key,
             [&](const Json& one, const std::string& name) { list.push_back(keys_.text_in(one, name)); });
        return list;
    }
    // Of an object, or of nothing.
    LineKeys inside(const std::string& key) {
        static const Json nothing = Json::object();
        const Json* found = find(key);
        return LineKeys(keys_.inside(found == nullptr ? nothing : *found, key));
    }
    void each(const std::string& key, const std::function<void(const Json&, const std::string&)>& visit) {
        const Json* found = find(key);
        if (found == nullptr) { return; }
        if (!found->is_array()) { keys_.fail(keys_.name(key), "is not a list"); }
        for (std::size_t i = 0; found->is_array() && i < found->size(); ++i) {
            visit((*found)[i], keys_.name(key) + "[" + std::to_string(i) + "]");
        }
    }
    JsonKeys& keys() { return keys_; }

private:
    JsonKeys keys_;
};

FleetNumber read_coefficient(LineKeys keys) {
    FleetNumber number;
    const bool is_identified = keys.text("state") == "identified";
    if (is_identified) {
        number.value = keys.number("value");
        number.sd = keys.number("sd");
    } else {
        number.upper = keys.number("upper");
    }
    return number;
}

FleetNumber read_bias(LineKeys keys, std::string& unit) {
    FleetNumber bias{keys.number("value"), std::nullopt, std::nullopt};
    const auto expanded = keys.number("expanded_uncertainty");
    const auto factor = keys.number("coverage_factor");
    if (expanded && factor && *factor > 0.0) { bias.sd = *expanded / *factor; }
    unit = keys.text("unit");
    return bias;
}

void read_axes(LineKeys keys, const std::string& sensor, std::vector<FleetAxis>& axes) {
    const Json* found = keys.find("axes");
    if (found == nullptr) { return; }
    if (!found->is_object()) { return keys.keys().fail(keys.keys().name("axes"), "is not an object"); }
    LineKeys all = keys.inside("axes");
    for (const auto& item : found->items()) {
        LineKeys of = all.inside(item.key());
        FleetAxis& axis = axes.emplace_back();
        axis.sensor = sensor;
        axis.axis = item.key();
        const bool is_gyro = sensor == "gyro";
        const FleetNumber mean = read_bias(of.inside(is_gyro ? "bias" : "mean"), axis.unit);
        if (is_gyro) { axis.bias = mean; }
        LineKeys coefficients = of.inside("coefficients");
        for (std::size_t i = 0; i < fleet_coefficients.size(); ++i) {
            axis.coefficients[i] = read_coefficient(coefficients.inside(fleet_coefficients[i]));
        }
        axis.comparison = of.text("sentence");
    }
}

void read_analysis(LineKeys& keys, FleetLine& line) {
    LineKeys recording = keys.inside("recording");
    line.board = recording.text("board");
    line.started = recording.text("started");
    line.temperature_C = recording.number("temperature_C");
    line.rate_hz = recording.number("rate_hz");
    line.duration_s = recording.number("duration_s");
    line.samples = recording.count("samples");
    line.missing = recording.inside("dropouts").count("samples");
    read_axes(keys, "gyro", line.axes);
    if (keys.find("accelerometer") != nullptr) {
        read_axes(keys.inside("accelerometer"), "accelerometer", line.axes);
    }
}

void read_check(LineKeys& keys, FleetLine& line) {
    line.board = keys.text("board");
    line.started = keys.text("started");
    line.rate_hz = keys.number("rate_hz");
    line.duration_s = keys.number("duration_s");
    LineKeys samples = keys.inside("samples");
    line.samples = samples.count("good");
    line.missing = samples.count("missing");
    line.end = keys.text("end");
}

void read_comparison(LineKeys& keys, FleetLine& line) {
    line.rate_hz = keys.number("rate_hz");
    line.duration_s = keys.number("duration_s");
    line.samples = keys.count("samples");
    line.seed = keys.count("seed");
    read_axes(LineKeys(keys), "gyro", line.axes);
}

void read_diagnosis(LineKeys& keys, FleetLine& line) {
    line.rate_hz = keys.number("rate_hz");
    line.duration_s = keys.number("duration_s");
    line.samples = keys.count("samples");
    line.seed = keys.count("seed");
    line.verdict = keys.text("verdict");
    line.gap_before = keys.inside("gap_before").number("value");
    line.gap_named = keys.inside("gap_named").number("value");
    line.gap_after = keys.inside("gap_after").number("value");
    for (const std::string& name : keys.texts("axes")) {
        FleetAxis& axis = line.axes.emplace_back();
        axis.sensor = "gyro";
        axis.axis = name;
    }
    keys.each("causes", [&](const Json& one, const std::string& name) {
        // Its own keys' names begin with the list's place.
        LineKeys of(keys.keys().inside(one, name));
        line.causes.push_back({of.text("effect"), of.texts("axes"), of.number("share")});
    });
}

struct KnownSchema {
    const char* schema;
    const char* command;
    void (*read)(LineKeys& keys, FleetLine& line);
};

constexpr std::array known_schemas{
    KnownSchema{"gyrolog-analysis/1", "analyze", read_analysis},
    KnownSchema{"gyrolog-check/1", "check", read_check},
    KnownSchema{"gyrolog-compare/1", "compare", read_comparison},
    KnownSchema{"gyrolog-diagnosis/2", "diagnose", read_diagnosis},
};

void read_common(LineKeys& keys, FleetLine& line) {
    line.error = keys.text("error");
    line.version = keys.text("reported_by");
    line.seconds = keys.number("seconds");
    if (const auto exit = keys.count("exit")) {
        if (*exit > 255) { keys.keys().fail("exit", "is no exit code"); }
        line.exit = static_cast<int>(std::min<std::uint64_t>(*exit, 255));
    } else if (line.error.empty()) {
        line.exit = 0;
    }
}

Error too_long(std::size_t number) {
    return malformed(fmt::format("line {}: longer than {} bytes", number, input_limits.json_bytes_most));
}

// What takes a file's text apart into lines, none of which may be longer than the limit.
Status each_line(const std::string& path, const std::function<Status(std::string_view, std::size_t)>& visit) {
    GYROLOG_TRY(TextReader reader, TextReader::open(path));
    std::string pending;
    std::size_t number = 0;
    const auto take = [&](std::string_view line) -> Status {
        ++number;
        if (line.size() > input_limits.json_bytes_most) { return too_long(number); }
        if (line.ends_with('\r')) { line.remove_suffix(1); }
        return line.find_first_not_of(" \t") == std::string_view::npos ? Status() : visit(line, number);
    };
    while (true) {
        GYROLOG_TRY(const std::string_view piece, reader.read());
        if (piece.empty()) { break; }
        pending += piece;
        std::size_t begin = 0;
        for (std::size_t end = 0; (end = pending.find('\n', begin)) != std::string::npos; begin = end + 1) {
            GYROLOG_CHECK(take(std::string_view(pending).substr(begin, end - begin)));
        }
        pending.erase(0, begin);
        if (pending.size() > input_limits.json_bytes_most) { return too_long(number + 1); }
    }
    return pending.empty() ? Status() : take(pending);
}

}  // namespace

Result<FleetLine> parse_fleet_line(std::string_view text) {
    GYROLOG_TRY(const Json json, parse_json_line(text, input_limits.json_line_keys_most));
    if (!json.is_object()) { return malformed("no JSON object"); }
    std::optional<std::string> problem;
    LineKeys keys(JsonKeys(json, "", problem));
    FleetLine line;
    line.file = keys.text("file");
    read_common(keys, line);
    const std::string schema = keys.text("schema");
    line.command = keys.text("command");
    if (!schema.empty()) {
        const auto* known =
            std::ranges::find_if(known_schemas, [&](const KnownSchema& one) { return schema == one.schema; });
        if (known == known_schemas.end()) {
            return malformed("schema is " + in_quotes(schema) +
                             ": not one of analyze, check, compare or diagnose");
        }
        line.command = known->command;
        known->read(keys, line);
    } else if (line.error.empty()) {
        keys.keys().fail("schema", "is missing, and so is error");
    }
    if (line.file.empty()) { keys.keys().fail("file", "is missing: --jsonl writes it into each line"); }
    if (problem) { return malformed(*problem); }
    return line;
}

Result<std::vector<FleetLine>> read_fleet_lines(const std::string& path) {
    std::vector<FleetLine> lines;
    const Status read = each_line(path, [&](std::string_view text, std::size_t number) -> Status {
        auto line = parse_fleet_line(text);
        if (!line.ok()) {
            Error error = in_context("line " + std::to_string(number), std::move(line).error());
            // Of another file not even the first is one.
            if (lines.empty()) {
                error.message +=
                    "; results are lines that analyze, check, compare or diagnose wrote with --jsonl";
            }
            return error;
        }
        lines.push_back(std::move(line).value());
        return {};
    });
    if (!read.ok()) { return in_context("read '" + path + "'", read.error()); }
    return lines;
}

Result<std::vector<std::string>> read_name_list(const std::string& path) {
    std::vector<std::string> names;
    const Status read = each_line(path, [&](std::string_view text, std::size_t number) -> Status {
        if (text.find('\0') != std::string_view::npos) {
            return malformed(fmt::format("line {}: this is no text: names stand in it one a line", number));
        }
        const std::size_t begin = text.find_first_not_of(" \t");
        const std::size_t end = text.find_last_not_of(" \t");
        names.emplace_back(text.substr(begin, end - begin + 1));
        return {};
    });
    if (!read.ok()) { return in_context("read '" + path + "'", read.error()); }
    return names;
}

}  // namespace gyrolog
