#include "host/formats/gyroparams_json.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/recording/standard_gravity.hpp"
#include "host/formats/json.hpp"
#include "host/formats/json_keys.hpp"

namespace gyrolog {

namespace {

using Range = JsonKeys::Range;

Vector3 vector_or_zero(JsonKeys& keys, const std::string& key, Range range) {
    Vector3 values{};
    const Json* given = keys.find(key);
    if (given == nullptr) { return values; }
    if (!given->is_array()) {
        values.fill(keys.number_in(*given, key, range));
        return values;
    }
    values = keys.numbers<3>(*given, key);
    for (const double value : values) {
        if (range == Range::not_negative && value < 0.0) { keys.fail(key, "is negative"); }
    }
    return values;
}

bool is_any(const Vector3& values) {
    return std::ranges::any_of(values, [](double value) { return value != 0.0; });
}

void read_noise(JsonKeys& keys, SensorModel& model) {
    const Vector3 density = vector_or_zero(keys, "NoiseDensity", Range::not_negative);
    const Vector3 instability = vector_or_zero(keys, "BiasInstability", Range::not_negative);
    const Vector3 walk = vector_or_zero(keys, "RandomWalk", Range::not_negative);
    double sides = 1.0;
    if (keys.find("NoiseType") != nullptr || is_any(density) || is_any(instability) || is_any(walk)) {
        const std::string type = keys.text("NoiseType");
        if (type == "double-sided") { sides = std::sqrt(2.0); }
        if (type != "single-sided" && type != "double-sided") {
            keys.fail("NoiseType", "is neither single-sided nor double-sided");
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        model.axes[axis].noise.N_rad_per_sqrt_s = density[axis] / sides;
        model.axes[axis].noise.B_rad_per_s = instability[axis];
        model.axes[axis].noise.K_rad_per_s_sqrt_s = walk[axis] * sides;
    }
}

void read_misalignment(JsonKeys& keys, SensorModel& model) {
    const std::string key = "AxesMisalignment";
    const Json* given = keys.find(key);
    if (given == nullptr) { return; }
    if (given->is_array() && !given->empty() && given->front().is_array()) {
        model.M = keys.matrix_in(*given, key);
        for (Vector3& row : model.M) {
            for (double& value : row) { value *= percent; }
        }
        return;
    }
    Vector3 leak = vector_or_zero(keys, key, Range::any);
    for (double& value : leak) { value *= percent; }
    model.misalignment = leak;
}

void read_temperature(JsonKeys& keys, SensorModel& model) {
    TemperatureModel temperature;
    temperature.bias_rad_s_per_C = vector_or_zero(keys, "TemperatureBias", Range::any);
    temperature.scale_per_C = vector_or_zero(keys, "TemperatureScaleFactor", Range::any);
    for (double& slope : temperature.scale_per_C) { slope *= percent; }
    if (is_any(temperature.bias_rad_s_per_C) || is_any(temperature.scale_per_C)) {
        model.temperature = temperature;
    }
}

void read_acceleration_bias(JsonKeys& keys, SensorModel& model) {
    constexpr std::array params = {"x_dps_per_g", "y_dps_per_g", "z_dps_per_g"};
    const Vector3 s_per_m = vector_or_zero(keys, "AccelerationBias", Range::any);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (s_per_m[axis] == 0.0) { continue; }
        EffectModel effect;
        effect.effect = "g_sensitivity";
        effect.axes = {axis_names[axis]};
        effect.params = {{params[axis], s_per_m[axis] * standard_gravity_m_s2 * deg_per_rad}};
        model.effects.push_back(std::move(effect));
    }
}

}  // namespace

SensorModel read_gyroparams(const Json& document, std::optional<std::string>& problem,
                            std::vector<std::string>& notes) {
    SensorModel model;
    JsonKeys keys(document, "", problem);
    keys.find("schema");
    model.rate_hz = keys.number("SampleRate", Range::positive);
    model.full_scale_rad_s =
        keys.optional_number("MeasurementRange", Range::positive).value_or(no_range_rad_s);
    model.saturation_rad_s = model.full_scale_rad_s;
    model.lsb_rad_s = keys.number_or("Resolution", Range::not_negative, 0.0);
    const Vector3 bias = vector_or_zero(keys, "ConstantBias", Range::any);
    for (std::size_t axis = 0; axis < 3; ++axis) { model.axes[axis].bias_rad_s = bias[axis]; }
    read_noise(keys, model);
    read_misalignment(keys, model);
    read_temperature(keys, model);
    read_acceleration_bias(keys, model);
    if (keys.find("BiasInstabilityCoefficients") != nullptr) {
        notes.emplace_back(
            "BiasInstabilityCoefficients has no effect: 1/f noise is simulated at all frequencies");
    }
    keys.refuse_left_over();
    return model;
}

}  // namespace gyrolog
