#pragma once

#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

// From zero at the first sample; step_sd_rad_s: K / sqrt(rate).
struct RateRandomWalk {
    RandomStream stream;
    double step_sd_rad_s;
    double state_rad_s = 0.0;

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        std::array<double, block_samples> draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        const std::span<double> used = std::span(draws).first(rate_rad_s.size());
        stream.normals(first_index, used);
        double walk_rad_s = state_rad_s;  // stays in a register: `rate_rad_s` cannot alias it
        for (std::size_t i = 0; i < used.size(); ++i) {
            rate_rad_s[i] += walk_rad_s;
            walk_rad_s += step_sd_rad_s * used[i];
        }
        state_rad_s = walk_rad_s;
    }
};

}  // namespace gyrolog
