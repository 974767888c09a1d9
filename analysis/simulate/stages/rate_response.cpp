#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

class RateResponse final : public Stage {
public:
    explicit RateResponse(const SensorModel& model) : gain_(model.M) {
        if (!model.misalignment) { return; }
        // Each axis' number is the leak of the rate about it into the other two, a column of the matrix: so
        // MathWorks' gyroparams has it (AxesMisalignment; its generated code fills column k with number k).
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
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.rate_rad_s[axis][i] += gain[0] * block.true_rate_rad_s[0][i] +
                                             gain[1] * block.true_rate_rad_s[1][i] +
                                             gain[2] * block.true_rate_rad_s[2][i];
            }
        }
    }

private:
    Matrix3 gain_;
};

}  // namespace

std::unique_ptr<Stage> make_rate_response(const StageContext& context) {
    return context.world != nullptr && context.world->moves() ? std::make_unique<RateResponse>(context.model)
                                                              : nullptr;
}

}  // namespace gyrolog
