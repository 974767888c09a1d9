#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

class RateResponse final : public Stage {
public:
    explicit RateResponse(const SensorModel& model) : gain_(model.M), temperature_(model.temperature) {
        if (!model.misalignment) { return; }
        // Each axis' number is its leak into the other two.
        const Vector3& leak = *model.misalignment;
        const Matrix3 mixed = gain_;
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t from = 0; from < 3; ++from) {
                for (std::size_t through = 0; through < 3; ++through) {
                    if (through != from) { gain_[row][from] += mixed[row][through] * leak[from]; }
                }
            }
        }
    }

    void apply(SampleBlock& block) override {
        if (!block.moving) { return; }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Vector3& gain = gain_[axis];
            const double per_C = temperature_ ? temperature_->scale_per_C[axis] : 0.0;
            const double reference_C = temperature_ ? temperature_->reference_C : 0.0;
            for (std::size_t i = 0; i < block_samples; ++i) {
                const double rate_rad_s = gain[0] * block.true_rate_rad_s[0][i] +
                                          gain[1] * block.true_rate_rad_s[1][i] +
                                          gain[2] * block.true_rate_rad_s[2][i];
                block.rate_rad_s[axis][i] += rate_rad_s * (1.0 + per_C * (block.die_C[i] - reference_C));
            }
        }
    }

private:
    Matrix3 gain_;
    std::optional<TemperatureModel> temperature_;
};

}  // namespace

std::unique_ptr<Stage> make_rate_response(const StageContext& context) {
    return context.world != nullptr && context.world->moves() ? std::make_unique<RateResponse>(context.model)
                                                              : nullptr;
}

}  // namespace gyrolog
