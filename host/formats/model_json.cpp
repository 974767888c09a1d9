#include "host/formats/model_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/recorded_converter.hpp"
#include "host/base/byte_size.hpp"
#include "host/base/file_output.hpp"
#include "host/base/nearest_name.hpp"
#include "host/base/printable.hpp"
#include "host/formats/datasheet_json.hpp"
#include "host/formats/gyroparams_json.hpp"
#include "host/formats/input_limits.hpp"
#include "host/formats/json.hpp"
#include "host/formats/json_keys.hpp"
#include "host/formats/population_json.hpp"
#include "host/formats/text_file.hpp"

namespace gyrolog {

namespace {

using Range = JsonKeys::Range;
using Keys = JsonKeys;

constexpr const char* schema_name = "gyrolog-model/1";

void carry(Json& carried, const std::string& key, Json rest) {
    if (!rest.empty()) { carried[key] = std::move(rest); }
}

// The factor by which N, B and K of the file exceed those of the two-sided convention.
double coefficient_factor(Keys& keys) {
    const Json* noise_type = keys.find("noise_type");
    if (noise_type == nullptr || *noise_type == "two_sided") { return 1.0; }
    if (*noise_type != "one_sided") { keys.fail("noise_type", "is neither two_sided nor one_sided"); }
    // A one-sided density holds the power of both sides: twice the two-sided one, so sqrt(2) in each
    // coefficient.
    return std::sqrt(2.0);
}

// Keys that a file need not have, with those that it has not.
class StatedNumbers {
public:
    explicit StatedNumbers(std::string of = "") : of_(std::move(of)) {}

    // 0 where it is not stated.
    double number(Keys& keys, const std::string& key, Range range) {
        const std::optional<double> stated = keys.optional_number(key, range);
        if (!stated && std::ranges::count(absent_, of_ + key) == 0) { absent_.push_back(of_ + key); }
        return stated.value_or(0.0);
    }

    void note(std::vector<std::string>& notes) const {
        if (absent_.empty()) { return; }
        notes.push_back(
            fmt::format("the model does not state {}: taken as 0, exactly", fmt::join(absent_, ", ")));
    }

private:
    std::string of_;
    std::vector<std::string> absent_;
};

// Keys that nobody asked for and that resemble one that is, which was meant perhaps. Others describe the
// model to whoever wrote it.
class UnknownKeys {
public:
    void add(const Keys& keys) {
        const std::vector<std::string> known(keys.asked_for().begin(), keys.asked_for().end());
        const Json rest = keys.left_over();
        for (const auto& item : rest.items()) {
            if (told_.size() >= told_most) { return; }
            const std::string meant = nearest_name(item.key(), known);
            if (meant.empty()) { continue; }
            told_.push_back(in_quotes(keys.name(item.key())) + " (did you mean '" + meant + "'?)");
        }
    }

    void note(std::vector<std::string>& notes) const {
        if (told_.empty()) { return; }
        notes.push_back(fmt::format("the model has keys of no effect: {}{}", fmt::join(told_, ", "),
                                    told_.size() < told_most ? "" : ", ..."));
    }

private:
    static constexpr std::size_t told_most = 8;

    std::vector<std::string> told_;
};

// The keys of an axis with the units that this schema has, `rate` that of the sensor: "dps" or "g".
Json axis_units(const std::string& rate) {
    Json units;
    units["N"] = rate + "/sqrt(Hz)";
    units["B"] = rate;
    units["K"] = rate + "*sqrt(Hz)";
    units["Q"] = rate + "*s";
    units["R"] = rate + "/s";
    units["bias"] = rate;
    units["sd"] = "relative";
    units["sd_rel"] = "relative";
    return units;
}

// What a file says of its units converts nothing: numbers are in the schema's units, and a file that says
// others is told so. Gives back what it says besides.
Json read_units(Keys& keys, const std::string& rate, std::vector<std::string>& notes) {
    const Json* given = keys.find("units");
    if (given == nullptr || !given->is_object()) { return Json::object(); }
    Keys units = keys.inside(*given, "units");
    const Json known = axis_units(rate);
    for (const auto& [key, unit] : known.items()) {
        const Json* said = units.find(key);
        if (said == nullptr || *said == unit) { continue; }
        notes.push_back(fmt::format("the model says {} of {}: the number is read in {} all the same",
                                    said->is_string() ? in_quotes(said->get<std::string>()) : "no unit",
                                    in_quotes(units.name(key)), unit.get<std::string>()));
    }
    return units.left_over();
}

// `unit`: of the file's numbers, in SI.
AxisModel read_axis(Keys& keys, double unit, double factor, StatedNumbers& stated) {
    AxisModel axis;
    const bool has_any = std::ranges::any_of(std::array{"N", "B", "K", "bias"},
                                             [&](const char* key) { return keys.find(key) != nullptr; });
    if (!has_any) { keys.fail(keys.name("N"), "is missing, as are B, K and bias: one of them is needed"); }
    axis.noise.N_rad_per_sqrt_s = stated.number(keys, "N", Range::not_negative) * unit / factor;
    axis.noise.B_rad_per_s = stated.number(keys, "B", Range::not_negative) * unit / factor;
    axis.noise.K_rad_per_s_sqrt_s = stated.number(keys, "K", Range::not_negative) * unit / factor;
    axis.bias_rad_s = stated.number(keys, "bias", Range::any) * unit;
    axis.noise.Q_rad = keys.number_or("Q", Range::not_negative, 0.0) * unit;
    axis.noise.R_rad_per_s2 = keys.number_or("R", Range::any, 0.0) * unit;
    if (const Json* sd = keys.find("sd")) { axis.sd_rel = keys.uncertainties(*sd, "sd"); }
    return axis;
}

// Gives back what of `axes` is not known.
Json read_axes(Keys& keys, double unit, double factor, StatedNumbers& stated, UnknownKeys& unknown,
               std::array<AxisModel, 3>& axes) {
    Keys axes_keys = keys.inside(keys.need("axes"), "axes");
    Json carried = Json::object();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string axis = axis_names[i];
        Keys axis_keys = axes_keys.inside(axes_keys.need(axis), axis);
        axes[i] = read_axis(axis_keys, unit, factor, stated);
        unknown.add(axis_keys);
        carry(carried, axis, axis_keys.left_over());
    }
    unknown.add(axes_keys);
    carried.update(axes_keys.left_over());
    return carried;
}

TemperatureModel read_temperature(Keys& keys) {
    TemperatureModel temperature;
    temperature.reference_C = keys.number_or("reference_C", Range::any, temperature.reference_C);
    if (const Json* bias = keys.find("bias_dps_per_C")) {
        temperature.bias_rad_s_per_C = keys.numbers<3>(*bias, keys.name("bias_dps_per_C"));
        for (double& slope : temperature.bias_rad_s_per_C) { slope *= rad_per_deg; }
    }
    if (const Json* scale = keys.find("scale_percent_per_C")) {
        const std::string name = keys.name("scale_percent_per_C");
        if (scale->is_array()) {
            temperature.scale_per_C = keys.numbers<3>(*scale, name);
        } else {
            temperature.scale_per_C.fill(keys.number_in(*scale, name, Range::any));
        }
        for (double& slope : temperature.scale_per_C) { slope *= percent; }
    }
    return temperature;
}

// The effect behind a form that has no name of its own; empty where there is none.
std::string effect_of_form(std::string_view form) {
    for (const ChainLink& link : signal_chain()) {
        if (link.effect != nullptr && link.effect->form == form) { return std::string(link.effect->name); }
    }
    return {};
}

std::string_view form_of(const EffectModel& effect) {
    const EffectDefinition* definition = find_effect(effect.effect);
    return definition == nullptr ? std::string_view{} : definition->form;
}

// What takes an entry's first key for an effect's name.
using EffectNamer = std::string (*)(Keys& keys);

std::string named_effect(Keys& keys) { return keys.text("effect"); }

std::string named_form(Keys& keys) {
    const std::string form = keys.text("form");
    std::string effect = effect_of_form(form);
    if (effect.empty()) {
        keys.fail(keys.name("form"), "is " + in_quotes(form) + ", which this version does not know");
    }
    return effect;
}

EffectModel read_effect(Keys& keys, EffectNamer name_of, UnknownKeys& unknown) {
    EffectModel effect;
    effect.effect = name_of(keys);
    if (const Json* axes = keys.find("axes")) {
        if (!axes->is_array()) { keys.fail(keys.name("axes"), "is not a list"); }
        for (const Json& axis : *axes) {
            effect.axes.push_back(keys.text_in(axis, keys.name("axes") + "[]"));
        }
    }
    if (const Json* table = keys.find("table")) { effect.table = keys.columns(*table, "table"); }
    Json carried = keys.left_over();
    carried.erase("params");
    if (const Json* params = keys.find("params")) {
        Keys inside = keys.inside(*params, "params");
        for (const auto& item : params->items()) {
            if (!params->is_object() || !item.value().is_number()) { continue; }  // carried: of another kind
            effect.params[item.key()] = inside.number(item.key(), Range::any);
        }
        unknown.add(inside);
        carry(carried, "params", inside.left_over());
    }
    unknown.add(keys);
    if (!carried.empty()) { effect.carried_json = carried.dump(); }
    return effect;
}

void read_effects(Keys& keys, const std::string& key, EffectNamer name_of, UnknownKeys& unknown,
                  std::vector<EffectModel>& effects) {
    static const Json none = Json::array();
    const Json* given = keys.find(key);
    const Json& list = given == nullptr ? none : *given;
    if (!list.is_array()) { keys.fail(key, "is not a list"); }
    for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
        Keys effect_keys = keys.inside(list[i], key + "[" + std::to_string(i) + "]");
        effects.push_back(read_effect(effect_keys, name_of, unknown));
    }
}

// The converter and the rate.
Unstated read_sampling(Keys& keys, SensorModel& model) {
    const auto rate_hz = keys.optional_number("rate_hz", Range::positive);
    const auto step_dps = keys.optional_number("lsb_dps", Range::not_negative);
    const auto full_scale_dps = keys.optional_number("full_scale_dps", Range::positive);
    const auto saturation_dps = keys.optional_number("saturation_dps", Range::positive);
    model.rate_hz = rate_hz.value_or(0.0);
    model.lsb_rad_s = step_dps.value_or(0.0) * rad_per_deg;
    model.full_scale_rad_s = full_scale_dps ? *full_scale_dps * rad_per_deg : no_range_rad_s;
    model.saturation_rad_s = saturation_dps ? *saturation_dps * rad_per_deg : model.full_scale_rad_s;
    return {!rate_hz, !step_dps, !full_scale_dps, !saturation_dps && !full_scale_dps};
}

void read_sensor(Keys& keys, SensorModel& model, StatedNumbers& stated) {
    if (keys.find("M") != nullptr) { model.M = keys.matrix("M"); }
    model.latency_s = stated.number(keys, "latency_s", Range::any);
    model.timestamp_jitter_s = stated.number(keys, "timestamp_jitter_s", Range::not_negative);
    if (const Json* sd = keys.find("sd_rel")) { model.sd_rel = keys.uncertainties(*sd, "sd_rel"); }
    if (const Json* sd = keys.find("sd_abs")) { model.sd_abs = keys.uncertainties(*sd, "sd_abs"); }
    model.ref_noise_rad_s = stated.number(keys, "ref_noise_dps", Range::not_negative) * rad_per_deg;
    model.acc_noise_m_s2 = stated.number(keys, "acc_noise_g", Range::not_negative) * standard_gravity_m_s2;
    model.temp_noise_C = stated.number(keys, "temp_noise_C", Range::not_negative);
    if (keys.find("orientation") != nullptr) { model.orientation = keys.matrix("orientation"); }
    if (const Json* misalignment = keys.find("misalignment_percent")) {
        model.misalignment = keys.numbers<3>(*misalignment, "misalignment_percent");
        for (double& value : *model.misalignment) { value *= percent; }
    }
}

// Gives back what of it is not known.
Json read_accelerometer(Keys& keys, double factor, std::vector<std::string>& notes, UnknownKeys& unknown,
                        AccelerometerModel& model) {
    constexpr double g = standard_gravity_m_s2;
    StatedNumbers stated("accelerometer.");
    Json carried = Json::object();
    carry(carried, "axes", read_axes(keys, g, factor, stated, unknown, model.axes));
    model.lsb_m_s2 = keys.number_or("lsb_g", Range::not_negative, 0.0) * g;
    if (const auto range_g = keys.optional_number("full_scale_g", Range::positive)) {
        model.full_scale_m_s2 = *range_g * g;
    }
    const auto saturation_g = keys.optional_number("saturation_g", Range::positive);
    model.saturation_m_s2 = saturation_g ? *saturation_g * g : model.full_scale_m_s2;
    if (keys.find("M") != nullptr) { model.M = keys.matrix("M"); }
    if (const Json* sd = keys.find("sd_rel")) { model.sd_rel = keys.uncertainties(*sd, "sd_rel"); }
    if (const Json* sd = keys.find("sd_abs")) { model.sd_abs = keys.uncertainties(*sd, "sd_abs"); }
    read_effects(keys, "effects", named_effect, unknown, model.effects);
    read_effects(keys, "unnamed", named_form, unknown, model.effects);
    carry(carried, "units", read_units(keys, "g", notes));
    stated.note(notes);
    unknown.add(keys);
    carried.update(keys.left_over());
    return carried;
}

ModelFile read_document(const Json& document, std::optional<std::string>& problem) {
    ModelFile file;
    SensorModel& model = file.model;
    StatedNumbers stated;
    UnknownKeys unknown;
    Keys keys(document, "", problem);
    keys.find("schema");  // judged by the caller
    file.unstated = read_sampling(keys, model);
    read_sensor(keys, model, stated);

    Json carried = Json::object();
    const double factor = coefficient_factor(keys);
    carry(carried, "axes", read_axes(keys, rad_per_deg, factor, stated, unknown, model.axes));
    carry(carried, "units", read_units(keys, "dps", file.notes));

    if (const Json* temperature = keys.find("temperature")) {
        Keys temperature_keys = keys.inside(*temperature, "temperature");
        model.temperature = read_temperature(temperature_keys);
        unknown.add(temperature_keys);
        carry(carried, "temperature", temperature_keys.left_over());
    }
    stated.note(file.notes);
    if (const Json* accelerometer = keys.find("accelerometer")) {
        Keys inside = keys.inside(*accelerometer, "accelerometer");
        carry(carried, "accelerometer",
              read_accelerometer(inside, factor, file.notes, unknown, model.accelerometer.emplace()));
    }
    read_effects(keys, "effects", named_effect, unknown, model.effects);
    read_effects(keys, "unnamed", named_form, unknown, model.effects);
    unknown.add(keys);
    unknown.note(file.notes);
    carried.update(keys.left_over());
    if (!carried.empty()) { model.carried_json = carried.dump(); }
    return file;
}

// The value in a unit of so many SI units, with the fewest digits that come back as the same SI value.
double in_unit(double si, double unit) {
    const double exact = si / unit;
    std::array<char, 40> digits{};
    for (int precision = 0; precision < 17; ++precision) {
        const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), exact,
                                           std::chars_format::scientific, precision);
        double value = 0.0;
        std::from_chars(digits.data(), written.ptr, value);
        if (value * unit == si) { return value; }
    }
    return exact;
}

template <std::size_t size>
Json in_unit(const std::array<double, size>& si, double unit) {
    Json list = Json::array();
    for (const double value : si) { list.push_back(in_unit(value, unit)); }
    return list;
}

Json format_matrix(const Matrix3& matrix) {
    Json rows = Json::array();
    for (const Vector3& row : matrix) { rows.push_back(in_unit(row, 1.0)); }
    return rows;
}

Json format_map(const std::map<std::string, double>& numbers) {
    Json json = Json::object();
    for (const auto& [key, value] : numbers) { json[key] = value; }
    return json;
}

Json format_axis(const AxisModel& axis, double unit) {
    Json json;
    json["N"] = in_unit(axis.noise.N_rad_per_sqrt_s, unit);
    json["B"] = in_unit(axis.noise.B_rad_per_s, unit);
    json["K"] = in_unit(axis.noise.K_rad_per_s_sqrt_s, unit);
    json["bias"] = in_unit(axis.bias_rad_s, unit);
    if (axis.noise.Q_rad != 0.0) { json["Q"] = in_unit(axis.noise.Q_rad, unit); }
    if (axis.noise.R_rad_per_s2 != 0.0) { json["R"] = in_unit(axis.noise.R_rad_per_s2, unit); }
    if (!axis.sd_rel.empty()) { json["sd"] = format_map(axis.sd_rel); }
    return json;
}

// The unit is the seed's; what the sheet does not give is said.
ModelFile draw_from(const Datasheet& sheet, std::uint64_t seed) {
    DrawnUnit unit = draw_unit(sheet, seed);
    std::vector<std::string> notes = {fmt::format("a unit drawn from the data sheet{}{} by seed {}",
                                                  sheet.sensor.empty() ? "" : " of ", sheet.sensor, seed)};
    notes.insert(notes.end(), unit.notes.begin(), unit.notes.end());
    return {std::move(unit.model), std::move(notes), true};
}

ModelFile draw_from(const Population& population, std::uint64_t seed) {
    DrawnUnit unit = draw_unit(population, seed);
    std::vector<std::string> notes = {fmt::format("a unit drawn from the population by seed {}", seed)};
    notes.insert(notes.end(), unit.notes.begin(), unit.notes.end());
    const bool no_range = population.full_scale_rad_s == no_range_rad_s;
    return {std::move(unit.model), std::move(notes), true,
            Unstated{!population.rate_hz, population.lsb_rad_s <= 0.0, no_range, no_range}};
}

// Puts back what was carried: objects are merged, everything else is the carried value.
void put_back(Json& to, const Json& carried) {
    for (const auto& item : carried.items()) {
        if (item.value().is_object() && to.contains(item.key()) && to[item.key()].is_object()) {
            put_back(to[item.key()], item.value());
        } else if (!to.contains(item.key())) {
            to[item.key()] = item.value();
        }
    }
}

void put_back(Json& to, const std::string& carried_json) {
    const Json carried = Json::parse(carried_json, nullptr, false);
    if (carried.is_object()) { put_back(to, carried); }
}

Json format_effect(const EffectModel& effect) {
    Json entry;
    if (const std::string_view form = form_of(effect); !form.empty()) {
        entry["form"] = form;
    } else {
        entry["effect"] = effect.effect;
    }
    entry["axes"] = Json::array();
    for (const std::string& axis : effect.axes) { entry["axes"].push_back(axis); }
    if (!effect.params.empty() || effect.table.empty()) { entry["params"] = format_map(effect.params); }
    for (const auto& [name, column] : effect.table) { entry["table"][name] = column; }
    put_back(entry, effect.carried_json);
    return entry;
}

void put_effects(Json& json, const std::vector<EffectModel>& effects) {
    json["effects"] = Json::array();
    for (const EffectModel& effect : effects) {
        const bool is_unnamed = !form_of(effect).empty();
        json[is_unnamed ? "unnamed" : "effects"].push_back(format_effect(effect));
    }
}

Json format_accelerometer(const AccelerometerModel& model) {
    constexpr double g = standard_gravity_m_s2;
    Json json;
    json["full_scale_g"] = in_unit(model.full_scale_m_s2, g);
    json["lsb_g"] = in_unit(model.lsb_m_s2, g);
    json["saturation_g"] = in_unit(model.saturation_m_s2, g);
    for (std::size_t i = 0; i < 3; ++i) { json["axes"][axis_names[i]] = format_axis(model.axes[i], g); }
    json["units"] = axis_units("g");
    json["M"] = format_matrix(model.M);
    json["sd_rel"] = format_map(model.sd_rel);
    json["sd_abs"] = format_map(model.sd_abs);
    put_effects(json, model.effects);
    return json;
}

Result<SensorModel> standing_for_itself(Result<ModelFile> file, const std::string& name) {
    if (!file.ok()) { return std::move(file).error(); }
    if (file->unstated.rate) {
        return Error{ErrorCode::malformed, "model '" + name + "': rate_hz is missing"};
    }
    return std::move(file->model);
}

}  // namespace

// Read back, that is; a rate that is not stated need not be.
bool can_be_written(const ModelFile& file) {
    ModelFile rated = file;
    if (file.unstated.rate) { state_rate(rated, 1.0); }
    return parse_model(format_model(rated.model), "").ok();
}

void state_rate(ModelFile& file, double rate_hz) {
    file.model.rate_hz = rate_hz;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double& N = file.model.axes[axis].noise.N_rad_per_sqrt_s;
        N = std::hypot(N, std::exchange(file.unrated_sd_rad_s[axis], 0.0) / std::sqrt(rate_hz));
    }
}

void complete_from(const Recording& recording, ModelFile& file) {
    SensorModel& model = file.model;
    const Unstated unstated = std::exchange(file.unstated, {});
    const std::optional<RecordedConverter> converter = recorded_converter(recording);
    std::vector<std::string> taken;
    if (unstated.rate) {
        state_rate(file, recording.rate_hz);
        taken.push_back(fmt::format("rate_hz ({:.6g})", model.rate_hz));
    }
    if (converter && unstated.step && converter->step_rad_s > 0.0) {
        model.lsb_rad_s = converter->step_rad_s;
        taken.push_back(fmt::format("lsb_dps ({:.6g})", model.lsb_rad_s * deg_per_rad));
    }
    if (converter && unstated.full_scale) {
        model.full_scale_rad_s = converter->full_scale_rad_s;
        taken.push_back(fmt::format("full_scale_dps ({:.6g})", model.full_scale_rad_s * deg_per_rad));
    }
    if (converter && unstated.saturation) { model.saturation_rad_s = converter->saturation_rad_s; }
    if (!taken.empty()) {
        file.notes.push_back(
            fmt::format("the model does not state {}: taken from the recording", fmt::join(taken, ", ")));
    }
}

Result<ModelFile> parse_model_file(std::string_view text, const std::string& name, std::uint64_t seed) {
    GYROLOG_TRY(const JsonDocument document, parse_json_document(text, name));
    const auto schema = document.json["schema"].get<std::string>();
    std::optional<std::string> problem;
    ModelFile file;
    if (schema == schema_name) {
        file = read_document(document.json, problem);
    } else if (schema == datasheet_schema) {
        const Datasheet sheet = read_datasheet(document.json, problem);
        if (!problem) { file = draw_from(sheet, seed); }
    } else if (schema == population_schema) {
        const Population population = read_population(document.json, problem);
        if (!problem) { file = draw_from(population, seed); }
    } else if (schema == gyroparams_schema) {
        file.model = read_gyroparams(document.json, problem, file.notes);
    } else {
        return Error{
            ErrorCode::unsupported,
            fmt::format("model '{}': schema is {}, not '{}' (or '{}', '{}', '{}')", name, in_quotes(schema),
                        schema_name, datasheet_schema, population_schema, gyroparams_schema)};
    }
    // Numbers that are each fine can make one that is not finite.
    if (!problem && schema != schema_name && !can_be_written(file)) {
        problem = "holds a number too large or too small to work with";
    }
    if (!problem && !document.plain) { problem = "holds a number that is not finite"; }
    if (problem) { return Error{ErrorCode::malformed, "model '" + name + "': " + *problem}; }
    return file;
}

Result<SensorModel> parse_model(std::string_view text, const std::string& name, std::uint64_t seed) {
    return standing_for_itself(parse_model_file(text, name, seed), name);
}

std::string format_model(const SensorModel& model) {
    Json json;
    json["schema"] = schema_name;
    json["rate_hz"] = model.rate_hz;
    json["full_scale_dps"] = in_unit(model.full_scale_rad_s, rad_per_deg);
    json["lsb_dps"] = in_unit(model.lsb_rad_s, rad_per_deg);
    json["saturation_dps"] = in_unit(model.saturation_rad_s, rad_per_deg);
    for (std::size_t i = 0; i < 3; ++i) {
        json["axes"][axis_names[i]] = format_axis(model.axes[i], rad_per_deg);
    }
    json["units"] = axis_units("dps");
    json["M"] = format_matrix(model.M);
    json["latency_s"] = model.latency_s;
    json["timestamp_jitter_s"] = model.timestamp_jitter_s;
    json["sd_rel"] = format_map(model.sd_rel);
    json["sd_abs"] = format_map(model.sd_abs);
    json["ref_noise_dps"] = in_unit(model.ref_noise_rad_s, rad_per_deg);
    json["acc_noise_g"] = in_unit(model.acc_noise_m_s2, standard_gravity_m_s2);
    json["temp_noise_C"] = model.temp_noise_C;
    if (model.orientation) { json["orientation"] = format_matrix(*model.orientation); }
    if (model.misalignment) { json["misalignment_percent"] = in_unit(*model.misalignment, percent); }
    if (model.temperature) {
        Json& temperature = json["temperature"];
        temperature["reference_C"] = model.temperature->reference_C;
        temperature["bias_dps_per_C"] = in_unit(model.temperature->bias_rad_s_per_C, rad_per_deg);
        const Vector3& scale = model.temperature->scale_per_C;
        const bool same = scale[0] == scale[1] && scale[1] == scale[2];
        temperature["scale_percent_per_C"] =
            same ? Json(in_unit(scale[0], percent)) : in_unit(scale, percent);
    }
    if (model.accelerometer) { json["accelerometer"] = format_accelerometer(*model.accelerometer); }
    put_effects(json, model.effects);
    put_back(json, model.carried_json);
    return written_out(json, 2);
}

Result<SensorModel> read_model(const std::string& path, std::uint64_t seed) {
    return standing_for_itself(read_model_file(path, seed), path);
}

Result<ModelFile> read_model_file(const std::string& path, std::uint64_t seed) {
    GYROLOG_TRY(const std::string text, read_model_text(path));
    return parse_model_file(text, path, seed);
}

Result<std::string> read_model_text(const std::string& path, const std::string& called) {
    const std::string reading = fmt::format("read {} '{}'", called, path);
    auto reader = TextReader::open(path);
    std::string text;
    while (reader.ok()) {
        const auto piece = reader->read();
        if (!piece.ok()) { return in_context(reading, piece.error()); }
        if (piece->empty()) { return text; }
        if (text.empty() && begins_as_capture(*piece)) {
            return malformed(
                fmt::format("{}: this is a capture, not a {}; `gyrolog analyze {} --model "
                            "NEW.json` makes a model of one",
                            reading, called, shell_word(path)));
        }
        text.append(*piece);
        if (text.size() > input_limits.json_bytes_most) {
            return Error{ErrorCode::malformed,
                         fmt::format("{}: it is longer than {}, and no {} is", reading,
                                     format_bytes(input_limits.json_bytes_most), called)};
        }
    }
    return in_context(reading, reader.error());
}

Status write_model(const SensorModel& model, const std::string& path) {
    return write_file(path, as_bytes(format_model(model)));
}

}  // namespace gyrolog
