#include <cmath>

#include "analysis/simulate/stages/per_axis.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

struct RateRandomWalk {
    RandomStream stream;
    double step_sd_rad_s;
    double state_rad_s = 0.0;

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        std::array<double, block_samples> draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        const std::span<double> used = std::span(draws).first(rate_rad_s.size());
        stream.normals(first_index, used);
        for (std::size_t i = 0; i < used.size(); ++i) {
            rate_rad_s[i] += state_rad_s;
            state_rad_s += step_sd_rad_s * used[i];
        }
    }
};

}  // namespace

std::unique_ptr<Stage> make_rate_random_walk(const StageContext& context) {
    return PerAxis<RateRandomWalk>::make([&](std::size_t axis) -> std::optional<RateRandomWalk> {
        const double K = context.model.axes[axis].noise.K_rad_per_s_sqrt_s;
        if (K == 0.0) { return std::nullopt; }
        return RateRandomWalk{context.stream({'K', '0'}, axis), K / std::sqrt(context.rate_hz)};
    });
}

}  // namespace gyrolog
