// Reading a JSON file that has a schema: what is wrong is said with the name of the key.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/simulate/sensor_model.hpp"
#include "host/base/result.hpp"
#include "host/formats/json.hpp"

namespace gyrolog {

// What the number of a key that ends in _percent is multiplied by.
inline constexpr double percent = 0.01;

struct JsonDocument {
    Json json;          // an object
    bool plain = true;  // false: a number in it was not finite, and stands as text in its place
};

// `name` is what errors call the text. Error `malformed`: no JSON object, nested too deep.
Result<JsonDocument> parse_json_object(std::string_view text, const std::string& name);
// The same; also `malformed` without a schema.
Result<JsonDocument> parse_json_document(std::string_view text, const std::string& name);

// Any JSON in one line of a file, of so many keys at most. Error `malformed` with the reason alone: where it
// is no JSON ("column 7: ..."), nested too deep, too many keys.
Result<Json> parse_json_line(std::string_view line, std::size_t keys_most);

// Reads the keys of one JSON object. The first thing that is wrong is kept, with the key's full name; later
// reads then return defaults. Keys that nobody asked for are left over.
class JsonKeys {
public:
    enum class Range { any, not_negative, positive };

    JsonKeys(const Json& object, std::string path, std::optional<std::string>& problem);

    const Json* find(const std::string& key);
    const Json& need(const std::string& key);

    double number(const std::string& key, Range range) { return number_in(need(key), name(key), range); }
    double number_or(const std::string& key, Range range, double otherwise);
    std::optional<double> optional_number(const std::string& key, Range range);
    std::string text(const std::string& key) { return text_in(need(key), name(key)); }
    template <std::size_t size>
    std::array<double, size> numbers(const Json& value, const std::string& where) {
        std::array<double, size> list{};
        if (!value.is_array() || value.size() != size) {
            fail(where, "is not a list of " + std::to_string(size) + " numbers");
            return list;
        }
        for (std::size_t i = 0; i < size; ++i) {
            list[i] = number_in(value[i], where + "[" + std::to_string(i) + "]", Range::any);
        }
        return list;
    }
    Matrix3 matrix(const std::string& key) { return matrix_in(need(key), name(key)); }
    // An object of numbers.
    std::map<std::string, double> uncertainties(const Json& value, const std::string& key);

    // An object of lists of numbers.
    std::map<std::string, std::vector<double>> columns(const Json& value, const std::string& key);

    double number_in(const Json& value, const std::string& where, Range range);
    std::string text_in(const Json& value, const std::string& where);
    Matrix3 matrix_in(const Json& value, const std::string& where);

    std::string name(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
    void fail(const std::string& where, const std::string& what);
    JsonKeys inside(const Json& object, const std::string& key) const {
        return {object, name(key), *problem_};
    }

    // What was not asked for, as an object.
    Json left_over() const;
    // What was, whether it is there or not.
    const std::set<std::string>& asked_for() const { return known_; }
    // For a schema that carries nothing it does not know: a misspelt key would else be silently without
    // effect.
    void refuse_left_over();

private:
    const Json* object_;
    std::string path_;
    std::optional<std::string>* problem_;
    std::set<std::string> known_;
};

}  // namespace gyrolog
