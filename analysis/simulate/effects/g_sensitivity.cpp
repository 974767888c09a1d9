#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class GSensitivity final : public Stage {
public:
    explicit GSensitivity(const EffectUse& use)
        : s_per_m_{use["x_dps_per_g"], use["y_dps_per_g"], use["z_dps_per_g"]} {
        for (double& value : s_per_m_) { value *= rad_per_deg / standard_gravity_m_s2; }
        for (std::size_t axis = 0; axis < 3; ++axis) { acts_[axis] = use.acts_on(axis); }
    }

    void apply(SampleBlock& block) override {
        const BlockVectors& force = block.specific_force_m_s2;
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const double rate_rad_s =
                s_per_m_[0] * force[0][i] + s_per_m_[1] * force[1][i] + s_per_m_[2] * force[2][i];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (acts_[axis]) { block.rate_rad_s[axis][i] += rate_rad_s; }
            }
        }
    }

private:
    Vector3 s_per_m_;
    std::array<bool, 3> acts_{};
};

std::unique_ptr<Stage> make_g_sensitivity(const EffectUse& use) {
    return std::make_unique<GSensitivity>(use);
}

constexpr EffectParam sensed_along(std::string_view name, std::string_view meaning) {
    return {.name = name, .meaning = meaning, .plausible_from = -0.5, .plausible_to = 0.5, .otherwise = 0.0};
}

constexpr EffectParam g_sensitivity_params[] = {
    sensed_along("x_dps_per_g", "for specific force along the sensor's x"),
    sensed_along("y_dps_per_g", "for specific force along the sensor's y"),
    sensed_along("z_dps_per_g", "for specific force along the sensor's z"),
};

constexpr std::string_view g_sensitivity_linear[] = {"x_dps_per_g", "y_dps_per_g", "z_dps_per_g"};

constexpr EffectSignature g_sensitivity_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::acceleration,
    .needs_specific_force = true,
    .linear = g_sensitivity_linear,
    .words =
        "The rate follows the specific force: {x_dps_per_g} along x, {y_dps_per_g} along y, {z_dps_per_g} "
        "along z",
    .noun = "a sensitivity to the specific force",
    .decided_by = "tilts to all six faces at rest",
};

}  // namespace

constinit const EffectDefinition g_sensitivity_effect = {
    .name = "g_sensitivity",
    .model =
        "w + x_dps_per_g f_x + y_dps_per_g f_y + z_dps_per_g f_z, f the specific force in g "
        "(9.80665 m/s^2), gravity's own included",
    .source = "IEEE 528-2019 (acceleration-sensitive drift rate)",
    .params = g_sensitivity_params,
    .make = make_g_sensitivity,
    .signature = &g_sensitivity_signature,
};

}  // namespace gyrolog
