// Test side only: a simulation in memory, in a world made of formulas.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/sensor_simulator.hpp"

namespace gyrolog {

class FormulaWorld final : public World {
public:
    std::function<Vector3(double)> rate_rad_s;
    std::function<Vector3(double)> specific_force_m_s2 = [](double) {
        return Vector3{0.0, 0.0, standard_gravity_m_s2};
    };
    std::function<double(double)> temperature_C;  // empty: the simulator's own

    bool moves() const override { return rate_rad_s != nullptr; }
    bool is_measured() const override { return false; }
    void motion(std::span<const double> world_s, const std::array<std::span<double>, 3>& rates,
                const std::array<std::span<double>, 3>& forces) const override {
        for (std::size_t i = 0; i < world_s.size(); ++i) {
            const Vector3 rate = rate_rad_s(world_s[i]);
            const Vector3 force = specific_force_m_s2(world_s[i]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                rates[axis][i] = rate[axis];
                forces[axis][i] = force[axis];
            }
        }
    }
    bool has_temperature() const override { return temperature_C != nullptr; }
    void temperature(std::span<const double> world_s, std::span<double> out_C) const override {
        for (std::size_t i = 0; i < world_s.size(); ++i) { out_C[i] = temperature_C(world_s[i]); }
    }
};

inline std::shared_ptr<FormulaWorld> world_turning(std::function<Vector3(double)> rate_rad_s) {
    auto world = std::make_shared<FormulaWorld>();
    world->rate_rad_s = std::move(rate_rad_s);
    return world;
}

// Between -1 and 1, straight lines, zero at 0 and rising.
inline double triangle(double turns) {
    const double x = turns + 0.25;
    return 1.0 - 4.0 * std::fabs(x - std::floor(x) - 0.5);
}

// Three triangles of unlike periods: no two axes move alike.
inline std::shared_ptr<FormulaWorld> tumbling_world(double peak_rad_s) {
    return world_turning([peak_rad_s](double t_s) {
        return Vector3{peak_rad_s * triangle(t_s / 3.7), peak_rad_s * triangle(t_s / 2.3 + 0.1),
                       peak_rad_s * triangle(t_s / 1.7 + 0.3)};
    });
}

// No noise, no converter, 500 dps of full scale.
inline SensorModel ideal_model() {
    SensorModel model;
    model.full_scale_rad_s = 500.0 * rad_per_deg;
    model.saturation_rad_s = 1e9;
    return model;
}

inline SensorModel white_model(double N_rad_per_sqrt_s) {
    SensorModel model = ideal_model();
    for (AxisModel& axis : model.axes) { axis.noise.N_rad_per_sqrt_s = N_rad_per_sqrt_s; }
    return model;
}

inline EffectModel effect_entry(std::string name, std::map<std::string, double> params,
                                std::vector<std::string> axes = {}) {
    return {
        .effect = std::move(name), .axes = std::move(axes), .params = std::move(params), .carried_json = {}};
}

inline SensorModel with_effect(SensorModel model, std::string name, std::map<std::string, double> params,
                               std::vector<std::string> axes = {}) {
    model.effects.push_back(effect_entry(std::move(name), std::move(params), std::move(axes)));
    return model;
}

struct Simulated {
    std::vector<double> stamp_s;
    std::vector<double> world_s;
    std::vector<bool> lost;
    std::array<std::vector<double>, 3> true_rate_rad_s;
    std::array<std::vector<double>, 3> force_m_s2;
    std::vector<double> die_C;
    std::vector<double> temperature_C;
    std::array<std::vector<double>, 3> rate_rad_s;

    std::size_t size() const { return stamp_s.size(); }
};

inline Simulated simulate(const SensorModel& model, double rate_hz, std::uint64_t seed, std::size_t blocks,
                          std::shared_ptr<const World> world = nullptr) {
    const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
    Simulated out;
    SensorSimulator simulator(model, rate_hz, seed, std::move(world));
    for (std::size_t i = 0; i < blocks; ++i) {
        const SampleBlock& block = simulator.next_block();
        append(out.stamp_s, block.stamp_s);
        append(out.world_s, block.world_s);
        append(out.lost, block.lost);
        append(out.die_C, block.die_C);
        append(out.temperature_C, block.temperature_C);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            append(out.true_rate_rad_s[axis], block.true_rate_rad_s[axis]);
            append(out.force_m_s2[axis], block.specific_force_m_s2[axis]);
            append(out.rate_rad_s[axis], block.rate_rad_s[axis]);
        }
    }
    return out;
}

// Above this a chi-square variable comes once in 30000 times (E. B. Wilson, M. M. Hilferty, 1931).
inline double chi_square_limit(double degrees) {
    const double part = 2.0 / (9.0 * degrees);
    const double root = 1.0 - part + 4.0 * std::sqrt(part);
    return degrees * root * root * root;
}

}  // namespace gyrolog
