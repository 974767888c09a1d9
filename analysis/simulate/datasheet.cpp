#include "analysis/simulate/datasheet.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {

namespace {

constexpr double percent = 0.01;

// The order is part of what a seed means: new ones go to the end.
enum class Drawn : std::uint32_t {
    bias,
    bias_over_temperature,
    scale,
    scale_over_temperature,
    from_x,
    from_y,
    from_z,
    quadratic,
    cubic,
    per_x_force,
    per_y_force,
    per_z_force,
    clock
};

class UnitDraw {
public:
    explicit UnitDraw(std::uint64_t seed) : seed_(seed) {}

    // Uniform within +- half_width.
    double operator()(Drawn what, std::size_t axis, double half_width) const {
        constexpr std::uint32_t process = std::uint32_t{'D'} << 24U | std::uint32_t{'s'} << 16U;
        const RandomStream stream(
            seed_, process | static_cast<std::uint32_t>(axis) << 12U | static_cast<std::uint32_t>(what));
        return half_width * (2.0 * stream.uniform(0) - 1.0);
    }

private:
    std::uint64_t seed_;
};

double standard_uncertainty(double half_width) { return half_width / std::sqrt(3.0); }

Drawn of_axis(Drawn first, std::size_t axis) {
    return static_cast<Drawn>(static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(axis));
}

EffectModel effect_of(std::string name, std::vector<std::string> axes, std::map<std::string, double> params) {
    EffectModel effect;
    effect.effect = std::move(name);
    effect.axes = std::move(axes);
    effect.params = std::move(params);
    return effect;
}

void draw_gain(const Datasheet& sheet, const UnitDraw& draw, SensorModel& model) {
    const double scale = sheet.scale.value_or(0.0);
    const double cross_axis = sheet.cross_axis.value_or(0.0);
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t from = 0; from < 3; ++from) {
            model.M[row][from] = row == from ? 1.0 + draw(Drawn::scale, row, scale)
                                             : draw(of_axis(Drawn::from_x, from), row, cross_axis);
        }
    }
    if (sheet.scale || sheet.cross_axis) {
        model.sd_abs["M"] = standard_uncertainty(std::max(scale, cross_axis));
    }
}

void draw_over_temperature(const Datasheet& sheet, const UnitDraw& draw, SensorModel& model) {
    if (!sheet.zero_rate_over_temperature_rad_s && !sheet.scale_over_temperature) { return; }
    const double span_C =
        std::max(sheet.temperature_to_C - sheet.reference_C, sheet.reference_C - sheet.temperature_from_C);
    TemperatureModel& temperature = model.temperature.emplace();
    temperature.reference_C = sheet.reference_C;
    const double bias_rad_s_per_C = sheet.zero_rate_over_temperature_rad_s.value_or(0.0) / span_C;
    const double scale_per_C = sheet.scale_over_temperature.value_or(0.0) / span_C;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        temperature.bias_rad_s_per_C[axis] = draw(Drawn::bias_over_temperature, axis, bias_rad_s_per_C);
        temperature.scale_per_C[axis] = draw(Drawn::scale_over_temperature, axis, scale_per_C);
    }
    if (sheet.zero_rate_over_temperature_rad_s) {
        model.sd_abs["bias_dps_per_C"] = standard_uncertainty(bias_rad_s_per_C * deg_per_rad);
    }
    if (sheet.scale_over_temperature) {
        model.sd_abs["scale_percent_per_C"] = standard_uncertainty(scale_per_C / percent);
    }
}

void draw_effects(const Datasheet& sheet, const UnitDraw& draw, SensorModel& model) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<std::string> on = {axis_names[axis]};
        if (sheet.nonlinearity) {
            const double half = *sheet.nonlinearity / 2.0;
            model.effects.push_back(effect_of("nonlinearity", on,
                                              {{"quadratic", draw(Drawn::quadratic, axis, half)},
                                               {"cubic", draw(Drawn::cubic, axis, half)}}));
        }
        if (sheet.g_sensitivity_s_per_m) {
            const double half_dps = *sheet.g_sensitivity_s_per_m * standard_gravity_m_s2 * deg_per_rad;
            model.effects.push_back(effect_of("g_sensitivity", on,
                                              {{"x_dps_per_g", draw(Drawn::per_x_force, axis, half_dps)},
                                               {"y_dps_per_g", draw(Drawn::per_y_force, axis, half_dps)},
                                               {"z_dps_per_g", draw(Drawn::per_z_force, axis, half_dps)}}));
        }
    }
    if (sheet.rate) {
        model.effects.push_back(effect_of("clock_rate", {}, {{"rel", draw(Drawn::clock, 0, *sheet.rate)}}));
        model.sd_abs["rate_rel"] = standard_uncertainty(*sheet.rate);
    }
}

std::vector<std::string> not_given(const Datasheet& sheet) {
    const std::pair<const char*, bool> all[] = {
        {"bias instability", sheet.B_rad_per_s.has_value()},
        {"rate random walk", sheet.K_rad_per_s_sqrt_s.has_value()},
        {"zero-rate output", sheet.zero_rate_rad_s.has_value()},
        {"zero-rate output over temperature", sheet.zero_rate_over_temperature_rad_s.has_value()},
        {"scale tolerance", sheet.scale.has_value()},
        {"scale over temperature", sheet.scale_over_temperature.has_value()},
        {"cross-axis sensitivity", sheet.cross_axis.has_value()},
        {"nonlinearity", sheet.nonlinearity.has_value()},
        {"sensitivity to specific force", sheet.g_sensitivity_s_per_m.has_value()},
        {"tolerance of the sampling rate", sheet.rate.has_value()},
        {"noise of the thermometer", sheet.temperature_noise_C > 0.0},
        {"resolution", sheet.lsb_rad_s > 0.0},
    };
    std::string list;
    for (const auto& [name, given] : all) {
        if (!given) { list += (list.empty() ? "" : ", ") + std::string(name); }
    }
    if (list.empty()) { return {}; }
    return {"not in the data sheet, so not simulated: " + list};
}

}  // namespace

DrawnUnit draw_unit(const Datasheet& sheet, std::uint64_t seed) {
    const UnitDraw draw(seed);
    DrawnUnit unit;
    SensorModel& model = unit.model;
    model.rate_hz = sheet.rate_hz;
    model.full_scale_rad_s = sheet.full_scale_rad_s;
    model.lsb_rad_s = sheet.lsb_rad_s;
    constexpr double highest_code = 32767.0;
    model.saturation_rad_s = sheet.lsb_rad_s > 0.0 ? highest_code * sheet.lsb_rad_s : sheet.full_scale_rad_s;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        model.axes[axis].noise.N_rad_per_sqrt_s = sheet.N_rad_per_sqrt_s;
        model.axes[axis].noise.B_rad_per_s = sheet.B_rad_per_s.value_or(0.0);
        model.axes[axis].noise.K_rad_per_s_sqrt_s = sheet.K_rad_per_s_sqrt_s.value_or(0.0);
        model.axes[axis].bias_rad_s = draw(Drawn::bias, axis, sheet.zero_rate_rad_s.value_or(0.0));
    }
    if (sheet.zero_rate_rad_s) {
        model.sd_abs["bias_dps"] = standard_uncertainty(*sheet.zero_rate_rad_s * deg_per_rad);
    }
    draw_gain(sheet, draw, model);
    draw_over_temperature(sheet, draw, model);
    draw_effects(sheet, draw, model);
    model.temp_noise_C = sheet.temperature_noise_C;
    model.acc_noise_m_s2 = sheet.accelerometer_noise_m_s2;
    unit.notes = not_given(sheet);
    return unit;
}

}  // namespace gyrolog
