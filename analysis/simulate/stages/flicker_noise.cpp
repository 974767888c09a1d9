#include "analysis/simulate/flicker_noise.hpp"

#include <vector>

#include "analysis/simulate/stages/per_axis.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

struct Flicker {
    FlickerNoise noise;

    void add(std::uint64_t /*first_index*/, std::span<double> rate_rad_s) { noise.add_next(rate_rad_s); }
};

}  // namespace

std::unique_ptr<Stage> make_flicker_noise(const StageContext& context) {
    return PerAxis<Flicker>::make([&](std::size_t axis) -> std::optional<Flicker> {
        const double B_rad_per_s = context.model.axes[axis].noise.B_rad_per_s;
        if (B_rad_per_s == 0.0) { return std::nullopt; }
        std::vector<RandomStream> streams;
        for (unsigned part = 0; part < FlickerNoise::default_processes; ++part) {
            streams.push_back(context.stream({'B', '0'}, axis, part));
        }
        return Flicker{FlickerNoise(B_rad_per_s, streams)};
    });
}

}  // namespace gyrolog
