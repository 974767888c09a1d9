#pragma once

#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

// scale_rad_s: Q times the rate.
struct AngleQuantisation {
    RandomStream stream;
    double scale_rad_s;
    double before;  // the angle's error at the sample before, in units of Q; a draw from the start on

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        std::array<double, block_samples> draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        const std::span<double> used = std::span(draws).first(rate_rad_s.size());
        stream.normals(first_index, used);
        for (std::size_t i = 0; i < used.size(); ++i) {
            rate_rad_s[i] += scale_rad_s * (used[i] - before);
            before = used[i];
        }
    }
};

}  // namespace gyrolog
