#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

class NoiseSum final : public Stage {
public:
    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.rate_rad_s[axis][i] += block.white_rad_s[axis][i];
            }
        }
    }
};

}  // namespace

std::unique_ptr<Stage> make_noise_sum(const StageContext& /*context*/) {
    return std::make_unique<NoiseSum>();
}

}  // namespace gyrolog
