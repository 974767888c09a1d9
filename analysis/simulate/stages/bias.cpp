#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

class Bias final : public Stage {
public:
    explicit Bias(const SensorModel& model) {
        for (std::size_t axis = 0; axis < 3; ++axis) { bias_rad_s_[axis] = model.axes[axis].bias_rad_s; }
        if (model.temperature) {
            follows_temperature_ = true;
            reference_C_ = model.temperature->reference_C;
            slope_rad_s_per_C_ = model.temperature->bias_rad_s_per_C;
        }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (double& rate : block.slots(block.rate_rad_s[axis])) { rate += bias_rad_s_[axis]; }
            if (!follows_temperature_) { continue; }
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.rate_rad_s[axis][i] += slope_rad_s_per_C_[axis] * (block.die_C[i] - reference_C_);
            }
        }
    }

private:
    Vector3 bias_rad_s_{};
    bool follows_temperature_ = false;
    double reference_C_ = 0.0;
    Vector3 slope_rad_s_per_C_{};
};

}  // namespace

std::unique_ptr<Stage> make_bias(const StageContext& context) {
    return std::make_unique<Bias>(context.model);
}

}  // namespace gyrolog
