#include <cmath>
#include <optional>

#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

class WhiteNoise final : public Stage {
public:
    explicit WhiteNoise(const StageContext& context) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sd_rad_s_[axis] = context.model.axes[axis].noise.N_rad_per_sqrt_s * std::sqrt(context.rate_hz);
            streams_[axis] = context.stream({'N', '0'}, axis);
        }
    }

    void apply(SampleBlock& block) override {
        block.white_sd_rad_s = sd_rad_s_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (sd_rad_s_[axis] == 0.0) { continue; }
            BlockValues draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
            streams_[axis]->normals(block.first(), block.slots(draws));
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.white_rad_s[axis][i] += sd_rad_s_[axis] * draws[i];
            }
        }
    }

private:
    Vector3 sd_rad_s_{};
    std::array<std::optional<RandomStream>, 3> streams_;
};

}  // namespace

std::unique_ptr<Stage> make_white_noise(const StageContext& context) {
    return std::make_unique<WhiteNoise>(context);
}

}  // namespace gyrolog
