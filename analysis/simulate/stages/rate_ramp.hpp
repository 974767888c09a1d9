#pragma once

#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

// From zero at the first sample.
struct RateRamp {
    double step_rad_s;  // from one sample to the next

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) const {
        for (std::size_t i = 0; i < rate_rad_s.size(); ++i) {
            rate_rad_s[i] += step_rad_s * static_cast<double>(first_index + i);
        }
    }
};

}  // namespace gyrolog
