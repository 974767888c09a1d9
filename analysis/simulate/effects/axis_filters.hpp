// Effects that filter all that comes before them on an axis.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "analysis/simulate/effect.hpp"

namespace gyrolog {

// Axis: `signal(x)` and `noise(x)` filter the signal and the white noise, a sample each call, in order;
// `start(first_rad_s, white_sd_rad_s)` comes before the first: the signal's first value, and the standard
// deviation of the white noise.
template <typename Axis>
class AxisFilters final : public Stage {
public:
    // `make_axis(axis)` gives the Axis, and is asked for those that `use` acts on.
    template <typename Make>
    AxisFilters(const EffectUse& use, Make make_axis) {
        for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
            if (use.acts_on(axis)) { axes_[axis].emplace(make_axis(axis)); }
        }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
            if (!axes_[axis]) { continue; }
            BlockValues& rate = block.rate_rad_s[axis];
            BlockValues& white = block.white_rad_s[axis];
            if (block.first() == 0) { axes_[axis]->start(rate[0], block.white_sd_rad_s[axis]); }
            for (std::size_t i = block.begin; i < block.end; ++i) {
                rate[i] = axes_[axis]->signal(rate[i]) + axes_[axis]->noise(white[i]);
                white[i] = 0.0;
            }
        }
    }

private:
    std::array<std::optional<Axis>, 3> axes_;
};

}  // namespace gyrolog
