#include <cmath>

#include "analysis/simulate/stages/per_axis.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

struct WhiteNoise {
    RandomStream stream;
    double sd_rad_s;

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) const {
        std::array<double, block_samples> draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        const std::span<double> used = std::span(draws).first(rate_rad_s.size());
        stream.normals(first_index, used);
        for (std::size_t i = 0; i < used.size(); ++i) { rate_rad_s[i] += sd_rad_s * used[i]; }
    }
};

}  // namespace

std::unique_ptr<Stage> make_white_noise(const StageContext& context) {
    return PerAxis<WhiteNoise>::make([&](std::size_t axis) -> std::optional<WhiteNoise> {
        const double N = context.model.axes[axis].noise.N_rad_per_sqrt_s;
        if (N == 0.0) { return std::nullopt; }
        return WhiteNoise{context.stream({'N', '0'}, axis), N * std::sqrt(context.rate_hz)};
    });
}

}  // namespace gyrolog
