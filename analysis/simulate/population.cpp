#include "analysis/simulate/population.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/simulate/counter_random.hpp"

namespace gyrolog {
namespace {

// The order is part of what a seed means: new ones go to the end.
enum class DrawnValue : std::uint32_t { bias, Q, N, B, K, clock };

class PopulationDraw {
public:
    explicit PopulationDraw(std::uint64_t seed) : seed_(seed) {}

    double gaussian(DrawnValue what, std::size_t axis, const UnitSpread& spread) const {
        return spread.median + spread.sd * normal(what, axis);
    }
    double log_normal(DrawnValue what, std::size_t axis, const UnitSpread& spread) const {
        if (spread.median <= 0.0) { return 0.0; }
        return spread.median * std::exp(normal(what, axis) * spread.sd / spread.median);
    }

private:
    double normal(DrawnValue what, std::size_t axis) const {
        constexpr std::uint32_t process = std::uint32_t{'P'} << 24U | std::uint32_t{'o'} << 16U;
        const RandomStream stream(
            seed_, process | static_cast<std::uint32_t>(axis) << 12U | static_cast<std::uint32_t>(what));
        return stream.normal(0);
    }

    std::uint64_t seed_;
};

void draw_noise(const AxisPopulation& of, const PopulationDraw& draw, std::size_t axis, AxisModel& model) {
    const auto drawn = [&](DrawnValue what, const char* key, const std::optional<UnitSpread>& spread) {
        if (!spread) { return 0.0; }
        if (spread->median > 0.0) { model.sd_rel[key] = spread->sd / spread->median; }
        return draw.log_normal(what, axis, *spread);
    };
    model.noise.Q_rad = drawn(DrawnValue::Q, "Q", of.Q_rad);
    model.noise.N_rad_per_sqrt_s = drawn(DrawnValue::N, "N", of.N_rad_per_sqrt_s);
    model.noise.B_rad_per_s = drawn(DrawnValue::B, "B", of.B_rad_per_s);
    model.noise.K_rad_per_s_sqrt_s = drawn(DrawnValue::K, "K", of.K_rad_per_s_sqrt_s);
}

void draw_clock(const UnitSpread& rate_hz, const PopulationDraw& draw, SensorModel& model) {
    model.rate_hz = rate_hz.median;
    const double sd_rel = rate_hz.sd / rate_hz.median;
    if (sd_rel <= 0.0) { return; }
    EffectModel clock;
    clock.effect = "clock_rate";
    clock.params["rel"] = draw.gaussian(DrawnValue::clock, 0, {0.0, sd_rel});
    model.effects.push_back(std::move(clock));
    model.sd_abs["rate_rel"] = sd_rel;
}

std::vector<std::string> not_given(const Population& population) {
    std::string list;
    const auto note = [&](const std::string& what, bool given) {
        if (!given) { list += (list.empty() ? "" : ", ") + what; }
    };
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const AxisPopulation& of = population.axes[axis];
        const std::string ending = std::string(" of ") + axis_names[axis];
        note("bias" + ending, of.bias_rad_s.has_value());
        note("N" + ending, of.N_rad_per_sqrt_s.has_value());
        note("B" + ending, of.B_rad_per_s.has_value());
        note("K" + ending, of.K_rad_per_s_sqrt_s.has_value());
    }
    note("range", population.full_scale_rad_s < no_range_rad_s);
    note("resolution", population.lsb_rad_s > 0.0);
    if (list.empty()) { return {}; }
    return {"not in the population, so not simulated: " + list};
}

}  // namespace

DrawnUnit draw_unit(const Population& population, std::uint64_t seed) {
    const PopulationDraw draw(seed);
    DrawnUnit unit;
    SensorModel& model = unit.model;
    model.rate_hz = 0.0;
    model.full_scale_rad_s = population.full_scale_rad_s;
    model.lsb_rad_s = population.lsb_rad_s;
    constexpr double highest_code = 32767.0;
    model.saturation_rad_s = model.lsb_rad_s > 0.0 ? highest_code * model.lsb_rad_s : model.full_scale_rad_s;
    double widest_bias_rad_s = 0.0;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const AxisPopulation& of = population.axes[axis];
        draw_noise(of, draw, axis, model.axes[axis]);
        if (!of.bias_rad_s) { continue; }
        model.axes[axis].bias_rad_s = draw.gaussian(DrawnValue::bias, axis, *of.bias_rad_s);
        widest_bias_rad_s = std::max(widest_bias_rad_s, of.bias_rad_s->sd);
    }
    if (widest_bias_rad_s > 0.0) { model.sd_abs["bias_dps"] = widest_bias_rad_s * deg_per_rad; }
    if (population.rate_hz) { draw_clock(*population.rate_hz, draw, model); }
    unit.notes = not_given(population);
    return unit;
}

}  // namespace gyrolog
