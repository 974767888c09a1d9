// Effects that add to the rate what they make of the temperature.
#pragma once

#include <utility>

#include "analysis/simulate/effect.hpp"

namespace gyrolog {

// Bias: `double operator()(double die_C)`, rad/s, asked once a sample in order.
template <typename Bias>
class TemperatureBias final : public Stage {
public:
    // On the axes of `use`.
    TemperatureBias(const EffectUse& use, Bias bias) : bias_(std::move(bias)) {
        for (std::size_t axis = 0; axis < 3; ++axis) { acts_on_[axis] = use.acts_on(axis); }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const double bias_rad_s = bias_(block.die_C[i]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (acts_on_[axis]) { block.rate_rad_s[axis][i] += bias_rad_s; }
            }
        }
    }

private:
    Bias bias_;
    std::array<bool, 3> acts_on_{};
};

}  // namespace gyrolog
