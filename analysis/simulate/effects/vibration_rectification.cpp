#include "analysis/recording/standard_gravity.hpp"
#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class VibrationRectification final : public Stage {
public:
    explicit VibrationRectification(const EffectUse& use)
        : rad_s_per_g2_{use["x_dps_per_g2"], use["y_dps_per_g2"], use["z_dps_per_g2"]} {
        const auto& orientation = use.context().model.orientation;
        for (std::size_t along = 0; along < 3; ++along) {
            rad_s_per_g2_[along] *= rad_per_deg;
            const double up = orientation ? (*orientation)[along][2] : identity_matrix[along][2];
            gravity_rad_s_ += rad_s_per_g2_[along] * up * up;
            acts_[along] = use.acts_on(along);
        }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            double rate_rad_s = -gravity_rad_s_;
            for (std::size_t along = 0; along < 3; ++along) {
                const double force_g = block.specific_force_m_s2[along][i] / standard_gravity_m_s2;
                rate_rad_s += rad_s_per_g2_[along] * force_g * force_g;
            }
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (acts_[axis]) { block.rate_rad_s[axis][i] += rate_rad_s; }
            }
        }
    }

private:
    Vector3 rad_s_per_g2_;
    double gravity_rad_s_ = 0.0;
    std::array<bool, 3> acts_{};
};

std::unique_ptr<Stage> make_vibration_rectification(const EffectUse& use) {
    return std::make_unique<VibrationRectification>(use);
}

constexpr EffectParam rectified_along(std::string_view name, std::string_view meaning) {
    return {
        .name = name, .meaning = meaning, .plausible_from = -0.05, .plausible_to = 0.05, .otherwise = 0.0};
}

constexpr EffectParam vibration_rectification_params[] = {
    rectified_along("x_dps_per_g2", "for the square of the specific force along the sensor's x"),
    rectified_along("y_dps_per_g2", "for the square of the specific force along the sensor's y"),
    rectified_along("z_dps_per_g2", "for the square of the specific force along the sensor's z"),
};

}  // namespace

constinit const EffectDefinition vibration_rectification_effect = {
    .name = "vibration_rectification",
    .model =
        "w + sum over j of j_dps_per_g2 (f_j^2 - u_j^2), f the specific force in g, u what it is at "
        "rest with the body's z upward; of a vibration, what the world's samples show",
    .source = "IEEE 528-2019 (acceleration-squared-sensitive drift rate)",
    .params = vibration_rectification_params,
    .make = make_vibration_rectification,
};

}  // namespace gyrolog
