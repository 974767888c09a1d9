#include "analysis/simulate/stages/per_axis.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

struct AngleQuantisation {
    RandomStream stream;
    double scale_rad_s;  // Q times the rate
    double before = 0.0;

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

}  // namespace

std::unique_ptr<Stage> make_angle_quantisation(const StageContext& context) {
    return PerAxis<AngleQuantisation>::make([&](std::size_t axis) -> std::optional<AngleQuantisation> {
        const double Q_rad = context.model.axes[axis].noise.Q_rad;
        if (Q_rad == 0.0) { return std::nullopt; }
        return AngleQuantisation{context.stream({'Q', '0'}, axis), Q_rad * context.rate_hz};
    });
}

}  // namespace gyrolog
