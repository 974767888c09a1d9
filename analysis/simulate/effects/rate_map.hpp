// A stage that sends each rate of the axes it acts on through a function without memory.
#pragma once

#include <memory>
#include <utility>

#include "analysis/simulate/effect.hpp"

namespace gyrolog {

// Map: `double operator()(double rate_rad_s) const`.
template <typename Map>
class RateMap final : public Stage {
public:
    RateMap(const EffectUse& use, Map map) : map_(std::move(map)) {
        for (std::size_t axis = 0; axis < 3; ++axis) { acts_[axis] = use.acts_on(axis); }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!acts_[axis]) { continue; }
            for (double& rate_rad_s : block.slots(block.rate_rad_s[axis])) { rate_rad_s = map_(rate_rad_s); }
        }
    }

private:
    Map map_;
    std::array<bool, 3> acts_{};
};

template <typename Map>
std::unique_ptr<Stage> make_rate_map(const EffectUse& use, Map map) {
    return std::make_unique<RateMap<Map>>(use, std::move(map));
}

}  // namespace gyrolog
