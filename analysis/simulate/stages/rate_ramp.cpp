#include "analysis/simulate/stages/per_axis.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

struct RateRamp {
    double step_rad_s;  // from one sample to the next

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) const {
        for (std::size_t i = 0; i < rate_rad_s.size(); ++i) {
            rate_rad_s[i] += step_rad_s * static_cast<double>(first_index + i);
        }
    }
};

}  // namespace

std::unique_ptr<Stage> make_rate_ramp(const StageContext& context) {
    return PerAxis<RateRamp>::make([&](std::size_t axis) -> std::optional<RateRamp> {
        const double R = context.model.axes[axis].noise.R_rad_per_s2;
        if (R == 0.0) { return std::nullopt; }
        return RateRamp{R / context.rate_hz};
    });
}

}  // namespace gyrolog
