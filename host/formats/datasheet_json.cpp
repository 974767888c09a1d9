#include "host/formats/datasheet_json.hpp"

#include <cmath>

#include "analysis/recording/standard_gravity.hpp"
#include "host/formats/json.hpp"
#include "host/formats/json_keys.hpp"

namespace gyrolog {

namespace {

using Range = JsonKeys::Range;

constexpr double rad_per_s_per_deg_per_h = rad_per_deg / 3600.0;

// The factor by which the roots of the sheet's densities exceed the two-sided ones.
double noise_factor(JsonKeys& keys) {
    const std::string type = keys.text("noise_type");
    if (type == "one_sided") { return std::sqrt(2.0); }
    if (type != "two_sided") { keys.fail("noise_type", "is neither one_sided nor two_sided"); }
    return 1.0;
}

void read_noise(JsonKeys& keys, Datasheet& sheet) {
    const double factor = noise_factor(keys);
    const auto density_dps = keys.optional_number("noise_density_dps_per_sqrt_hz", Range::not_negative);
    const auto rms_dps = keys.optional_number("total_rms_noise_dps", Range::not_negative);
    const auto bandwidth_hz = keys.optional_number("noise_bandwidth_hz", Range::positive);
    if (rms_dps && !bandwidth_hz) {
        keys.fail("noise_bandwidth_hz", "is missing beside total_rms_noise_dps");
    }
    if (density_dps) {
        sheet.N_rad_per_sqrt_s = *density_dps * rad_per_deg / factor;
    } else if (rms_dps && bandwidth_hz) {
        sheet.N_rad_per_sqrt_s = *rms_dps * rad_per_deg / std::sqrt(2.0 * *bandwidth_hz);
    } else {
        keys.fail("noise_density_dps_per_sqrt_hz", "is missing, and so is total_rms_noise_dps");
    }
    if (const auto walk = keys.optional_number("rate_random_walk_dps_sqrt_hz", Range::not_negative)) {
        sheet.K_rad_per_s_sqrt_s = *walk * rad_per_deg / factor;
    }
    if (const auto lowest = keys.optional_number("bias_instability_deg_per_h", Range::not_negative)) {
        const double flat_of_B = std::sqrt(2.0 * std::log(2.0) / pi);  // IEEE Std 952-1997, annex C.1.3
        sheet.B_rad_per_s = *lowest * rad_per_s_per_deg_per_h / flat_of_B;
    }
}

void read_tolerances(JsonKeys& keys, Datasheet& sheet) {
    const auto in = [&](const char* key, double unit) -> std::optional<double> {
        const auto value = keys.optional_number(key, Range::not_negative);
        return value ? std::optional(*value * unit) : std::nullopt;
    };
    sheet.zero_rate_rad_s = in("zero_rate_output_dps", rad_per_deg);
    sheet.zero_rate_over_temperature_rad_s = in("zero_rate_output_over_temperature_dps", rad_per_deg);
    sheet.scale = in("scale_tolerance_percent", percent);
    sheet.scale_over_temperature = in("scale_over_temperature_percent", percent);
    sheet.cross_axis = in("cross_axis_percent", percent);
    sheet.nonlinearity = in("nonlinearity_percent", percent);
    sheet.g_sensitivity_s_per_m =
        in("linear_acceleration_sensitivity_dps_per_g", rad_per_deg / standard_gravity_m_s2);
    sheet.rate = in("rate_tolerance_percent", percent);
    if (sheet.rate && *sheet.rate >= 1.0) { keys.fail("rate_tolerance_percent", "is not below 100"); }
}

void read_temperatures(JsonKeys& keys, Datasheet& sheet) {
    sheet.reference_C = keys.number_or("reference_temperature_C", Range::any, sheet.reference_C);
    sheet.temperature_noise_C = keys.number_or("temperature_noise_C", Range::not_negative, 0.0);
    const Json* range = keys.find("temperature_range_C");
    if (range == nullptr) {
        if (sheet.zero_rate_over_temperature_rad_s || sheet.scale_over_temperature) {
            keys.fail("temperature_range_C", "is missing beside a tolerance over temperature");
        }
        return;
    }
    const auto ends_C = keys.numbers<2>(*range, "temperature_range_C");
    if (!(ends_C[0] < ends_C[1])) { keys.fail("temperature_range_C", "does not ascend"); }
    if (!(ends_C[0] <= sheet.reference_C && sheet.reference_C <= ends_C[1])) {
        keys.fail("temperature_range_C", "does not hold the reference temperature");
    }
    sheet.temperature_from_C = ends_C[0];
    sheet.temperature_to_C = ends_C[1];
}

}  // namespace

Datasheet read_datasheet(const Json& document, std::optional<std::string>& problem) {
    Datasheet sheet;
    JsonKeys keys(document, "", problem);
    for (const char* for_people : {"schema", "source"}) { keys.find(for_people); }
    if (keys.find("sensor") != nullptr) { sheet.sensor = keys.text("sensor"); }
    sheet.rate_hz = keys.number("rate_hz", Range::positive);
    sheet.full_scale_rad_s = keys.number("full_scale_dps", Range::positive) * rad_per_deg;
    if (const auto per_dps = keys.optional_number("sensitivity_lsb_per_dps", Range::positive)) {
        sheet.lsb_rad_s = rad_per_deg / *per_dps;
    }
    sheet.accelerometer_noise_m_s2 =
        keys.number_or("accelerometer_noise_g", Range::not_negative, 0.0) * standard_gravity_m_s2;
    read_noise(keys, sheet);
    read_tolerances(keys, sheet);
    read_temperatures(keys, sheet);
    keys.refuse_left_over();
    return sheet;
}

}  // namespace gyrolog
