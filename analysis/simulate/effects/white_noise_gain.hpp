// Effects that make the white noise larger or smaller, the model's and what other effects have made of it.
#pragma once

#include <utility>

#include "analysis/simulate/effect.hpp"

namespace gyrolog {

// However far the temperature goes, some noise is left.
inline constexpr double white_gain_least = 0.05;

// Gain: `double operator()(const SampleBlock& block, std::size_t i) const`, of slot i.
template <typename Gain>
class WhiteNoiseGain final : public Stage {
public:
    // On the axes of `use`.
    WhiteNoiseGain(const EffectUse& use, Gain gain) : gain_(std::move(gain)) {
        for (std::size_t axis = 0; axis < 3; ++axis) { acts_on_[axis] = use.acts_on(axis); }
    }

    void apply(SampleBlock& block) override {
        const double first_gain = gain_(std::as_const(block), block.begin);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (acts_on_[axis]) { block.white_sd_rad_s[axis] *= first_gain; }
        }
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const double gain = gain_(std::as_const(block), i);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (acts_on_[axis]) { block.white_rad_s[axis][i] *= gain; }
            }
        }
    }

private:
    Gain gain_;
    std::array<bool, 3> acts_on_{};
};

}  // namespace gyrolog
