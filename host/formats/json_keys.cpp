#include "host/formats/json_keys.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "host/base/printable.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {

namespace {

// Reads without keeping anything, up to the first error or what is beyond the limits.
class Inspection final : public nlohmann::json_sax<Json> {
public:
    explicit Inspection(std::string_view text, std::size_t keys_most = input_limits.json_keys_most)
        : text_(text), keys_most_(keys_most), sound_(Json::sax_parse(text, this)) {}

    // It is JSON, within the limits.
    bool sound() const { return sound_; }
    // Empty: within the limits, as far as it was read.
    const std::string& refusal() const { return refusal_; }
    // "line 3, column 7: unexpected ','; expected string literal"; empty without an error.
    std::string error() const {
        if (what_.empty()) { return {}; }
        const std::string_view before = text_.substr(0, std::min(position_, text_.size()));
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const std::size_t line_end = before.rfind('\n');
        const std::size_t column = before.size() - (line_end == std::string_view::npos ? 0 : line_end + 1);
        return "line " + std::to_string(line) + ", column " +
               std::to_string(std::max<std::size_t>(column, 1)) + ": " + reason();
    }
    // The same of a text of one line.
    std::string error_in_line() const {
        if (what_.empty()) { return {}; }
        return "column " + std::to_string(std::max<std::size_t>(position_, 1)) + ": " + reason();
    }

    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t /*value*/) override { return true; }
    bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
    bool string(string_t& /*value*/) override { return true; }
    bool binary(binary_t& /*value*/) override { return true; }
    bool start_object(std::size_t /*elements*/) override { return enter(); }
    bool key(string_t& /*value*/) override {
        if (++keys_ > keys_most_) { refusal_ = "more than " + std::to_string(keys_most_) + " keys"; }
        return refusal_.empty();
    }
    bool end_object() override { return leave(); }
    bool start_array(std::size_t /*elements*/) override { return enter(); }
    bool end_array() override { return leave(); }
    bool parse_error(std::size_t position, const std::string& /*token*/,
                     const Json::exception& error) override {
        position_ = position;
        what_ = error.what();
        return false;
    }

private:
    bool enter() {
        if (++depth_ > input_limits.json_nesting_most) {
            refusal_ = "nested more than " + std::to_string(input_limits.json_nesting_most) + " deep";
        }
        return refusal_.empty();
    }
    bool leave() {
        --depth_;
        return true;
    }
    // Of the library's own sentence, what is behind the last dash, and no more than fits a line.
    std::string reason() const {
        constexpr std::size_t shown_bytes_most = 120;
        const std::size_t dash = what_.rfind(" - ");
        const std::string reason = dash == std::string::npos ? what_ : what_.substr(dash + 3);
        return printable(reason.substr(0, shown_bytes_most));
    }

    std::string_view text_;
    std::size_t keys_most_;
    std::size_t keys_ = 0;
    int depth_ = 0;
    std::string refusal_;
    std::size_t position_ = 0;
    std::string what_;
    bool sound_;  // the last, for it is known when all has been read
};

std::string syntax_error(std::string_view text, const Inspection& inspection) {
    if (text.empty()) { return "the file is empty"; }
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
        return "the text is UTF-16: save it as UTF-8";
    }
    return inspection.error();
}

// JSON has no NaN, no infinity and no 1e999, but programs write them. Put in quotes they parse, and the error
// can name the key that holds one.
std::string quote_non_finite(std::string_view text) {
    std::string quoted;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (in_string || c == '"') {
            const bool escaped = in_string && c == '\\' && i + 1 < text.size();
            if (c == '"') { in_string = !in_string; }
            quoted.append(text.substr(i, escaped ? 2 : 1));
            i += escaped ? 2 : 1;
            continue;
        }
        const std::size_t end = std::min(text.find_first_of(" \t\r\n,:[]{}\"", i), text.size());
        const std::string_view token = text.substr(i, end - i);
        if (token.empty()) {
            quoted.push_back(c);
            ++i;
            continue;
        }
        double value = 0.0;
        const auto result = std::from_chars(token.data(), token.data() + token.size(), value);
        const bool whole = result.ptr == token.data() + token.size();
        const bool overflow = result.ec == std::errc::result_out_of_range;
        const bool named = token == "NaN" || token == "Infinity" || token == "-Infinity";
        if (named || (whole && (overflow || !std::isfinite(value)))) {
            quoted.append("\"").append(token).append("\"");
        } else {
            quoted.append(token);
        }
        i = end;
    }
    return quoted;
}

}  // namespace

Result<JsonDocument> parse_json_object(std::string_view text, const std::string& name) {
    const auto malformed = [&](const std::string& why) {
        return Error{ErrorCode::malformed, "model '" + name + "': " + why};
    };
    Inspection inspection(text);
    std::string quoted;
    if (!inspection.sound() && inspection.refusal().empty()) {
        quoted = quote_non_finite(text);
        inspection = Inspection(quoted);
    }
    if (!inspection.refusal().empty()) { return malformed(inspection.refusal()); }
    if (!inspection.sound()) { return malformed("no JSON: " + syntax_error(text, inspection)); }
    const bool plain = quoted.empty();
    Json document = Json::parse(plain ? text : std::string_view(quoted));
    if (!document.is_object()) { return malformed("not a JSON object"); }
    return JsonDocument{std::move(document), plain};
}

Result<JsonDocument> parse_json_document(std::string_view text, const std::string& name) {
    GYROLOG_TRY(JsonDocument document, parse_json_object(text, name));
    const auto malformed = [&](const std::string& why) {
        return Error{ErrorCode::malformed, "model '" + name + "': " + why};
    };
    const auto schema = document.json.find("schema");
    if (schema == document.json.end()) { return malformed("schema is missing"); }
    if (!schema->is_string()) { return malformed("schema is not text"); }
    return document;
}

Result<Json> parse_json_line(std::string_view line, std::size_t keys_most) {
    const Inspection inspection(line, keys_most);
    if (!inspection.refusal().empty()) { return malformed(inspection.refusal()); }
    if (!inspection.sound()) { return malformed("no JSON: " + inspection.error_in_line()); }
    return Json(Json::parse(line));
}

JsonKeys::JsonKeys(const Json& object, std::string path, std::optional<std::string>& problem)
    : object_(&object), path_(std::move(path)), problem_(&problem) {
    if (!object.is_object()) { fail(path_, "is not an object"); }
}

const Json* JsonKeys::find(const std::string& key) {
    known_.insert(key);
    if (!object_->is_object()) { return nullptr; }
    const auto found = object_->find(key);
    return found == object_->end() ? nullptr : &*found;
}

const Json& JsonKeys::need(const std::string& key) {
    static const Json nothing;
    const Json* found = find(key);
    if (found == nullptr) { fail(name(key), "is missing"); }
    return found == nullptr ? nothing : *found;
}

double JsonKeys::number_or(const std::string& key, Range range, double otherwise) {
    return optional_number(key, range).value_or(otherwise);
}

std::optional<double> JsonKeys::optional_number(const std::string& key, Range range) {
    const Json* found = find(key);
    if (found == nullptr) { return std::nullopt; }
    return number_in(*found, name(key), range);
}

Matrix3 JsonKeys::matrix_in(const Json& value, const std::string& where) {
    Matrix3 rows = identity_matrix;
    if (!value.is_array() || value.size() != 3) {
        fail(where, "is not a 3x3 matrix");
        return rows;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        rows[i] = numbers<3>(value[i], where + "[" + std::to_string(i) + "]");
    }
    return rows;
}

std::map<std::string, double> JsonKeys::uncertainties(const Json& value, const std::string& key) {
    std::map<std::string, double> numbers;
    if (!value.is_object()) {
        fail(name(key), "is not an object");
        return numbers;
    }
    for (const auto& item : value.items()) {
        numbers[item.key()] = number_in(item.value(), name(key) + "." + item.key(), Range::not_negative);
    }
    return numbers;
}

std::map<std::string, std::vector<double>> JsonKeys::columns(const Json& value, const std::string& key) {
    std::map<std::string, std::vector<double>> columns;
    if (!value.is_object()) { fail(name(key), "is not an object of columns"); }
    for (const auto& item : value.items()) {
        const std::string where = name(key) + "." + item.key();
        if (!item.value().is_array()) { fail(where, "is not a list of numbers"); }
        for (const Json& number : item.value()) {
            columns[item.key()].push_back(number_in(number, where + "[]", Range::any));
        }
    }
    return columns;
}

double JsonKeys::number_in(const Json& value, const std::string& where, Range range) {
    if (!value.is_number()) {
        fail(where, "is not a finite number");
        return 0.0;
    }
    const auto number = value.get<double>();
    if (!std::isfinite(number)) { fail(where, "is not a finite number"); }
    if (range == Range::not_negative && number < 0.0) { fail(where, "is negative"); }
    if (range == Range::positive && number <= 0.0) { fail(where, "is not above zero"); }
    return number;
}

std::string JsonKeys::text_in(const Json& value, const std::string& where) {
    if (value.is_string()) { return value.get<std::string>(); }
    fail(where, "is not text");
    return {};
}

void JsonKeys::fail(const std::string& where, const std::string& what) {
    if (!*problem_) { *problem_ = where + " " + what; }
}

Json JsonKeys::left_over() const {
    Json rest = Json::object();
    if (!object_->is_object()) { return rest; }
    for (const auto& item : object_->items()) {
        if (!known_.contains(item.key())) { rest[item.key()] = item.value(); }
    }
    return rest;
}

void JsonKeys::refuse_left_over() {
    const Json rest = left_over();
    if (!rest.empty()) { fail(name(rest.begin().key()), "is no key of this schema"); }
}

}  // namespace gyrolog
