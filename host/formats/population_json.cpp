#include "host/formats/population_json.hpp"

#include <cmath>

#include "host/base/program_name.hpp"
#include "host/formats/json.hpp"
#include "host/formats/json_keys.hpp"

namespace gyrolog {

namespace {

using Range = JsonKeys::Range;

std::optional<UnitSpread> read_spread(JsonKeys& keys, const std::string& key, Range of_median,
                                      double unit = 1.0) {
    const Json* found = keys.find(key);
    if (found == nullptr) { return std::nullopt; }
    JsonKeys inside = keys.inside(*found, key);
    const UnitSpread spread{inside.number("median", of_median) * unit,
                            inside.number("sd", Range::not_negative) * unit};
    for (const char* for_people : {"count", "sd_lo", "sd_hi", "observed_sd"}) { inside.find(for_people); }
    inside.refuse_left_over();
    return spread;
}

AxisPopulation read_axis(JsonKeys& keys) {
    AxisPopulation axis;
    axis.bias_rad_s = read_spread(keys, "bias", Range::any, rad_per_deg);
    axis.Q_rad = read_spread(keys, "Q", Range::not_negative, rad_per_deg);
    axis.N_rad_per_sqrt_s = read_spread(keys, "N", Range::not_negative, rad_per_deg);
    axis.B_rad_per_s = read_spread(keys, "B", Range::not_negative, rad_per_deg);
    axis.K_rad_per_s_sqrt_s = read_spread(keys, "K", Range::not_negative, rad_per_deg);
    keys.refuse_left_over();
    return axis;
}

void read_axes(JsonKeys& keys, Population& population) {
    JsonKeys axes = keys.inside(keys.need("axes"), "axes");
    bool any = false;
    for (std::size_t i = 0; i < axis_names.size(); ++i) {
        const std::string name = axis_names[i];
        const Json* found = axes.find(name);
        if (found == nullptr) { continue; }
        JsonKeys axis = axes.inside(*found, name);
        population.axes[i] = read_axis(axis);
        any = true;
    }
    if (!any) { axes.fail(axes.name("x"), "is missing, as are y and z: one of them is needed"); }
    axes.refuse_left_over();
}

Json spread_json(const RobustSpread& spread) {
    return {{"median", spread.median}, {"sd", spread.sd},       {"sd_lo", spread.sd_lo},
            {"sd_hi", spread.sd_hi},   {"count", spread.count}, {"observed_sd", spread.observed_sd}};
}

}  // namespace

Population read_population(const Json& document, std::optional<std::string>& problem) {
    Population population;
    JsonKeys keys(document, "", problem);
    for (const char* for_people : {"schema", "units", "probability", "recordings", "notes", "reported_by"}) {
        keys.find(for_people);
    }
    population.rate_hz = read_spread(keys, "rate_hz", Range::positive);
    if (const auto range_dps = keys.optional_number("full_scale_dps", Range::positive)) {
        population.full_scale_rad_s = *range_dps * rad_per_deg;
    }
    population.lsb_rad_s = keys.number_or("lsb_dps", Range::not_negative, 0.0) * rad_per_deg;
    read_axes(keys, population);
    keys.refuse_left_over();
    return population;
}

std::string format_population(const MeasuredPopulation& population) {
    Json json;
    json["schema"] = population_schema;
    json["units"] = population.units;
    json["probability"] = population.probability;
    json["axes"] = Json::object();
    for (const MeasuredParameter& one : population.parameters) {
        Json& of = one.axis.empty() ? json : json["axes"][one.axis];
        of[one.name] = spread_json(one.spread);
    }
    json["notes"] = population.notes;
    json["reported_by"] = program_name();
    return written_out(json, 2);
}

}  // namespace gyrolog
