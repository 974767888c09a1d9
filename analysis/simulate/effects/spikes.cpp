#include "analysis/simulate/effects/arrivals.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

namespace {

constexpr double seconds_per_hour = 3600.0;

struct Spikes {
    Arrivals arrivals;
    RandomStream sizes;
    double smallest_rad_s;
    double largest_rad_s;

    void add(std::uint64_t first_index, std::span<double> rate_rad_s) {
        for (; arrivals.sample() < first_index + rate_rad_s.size(); arrivals.next()) {
            rate_rad_s[arrivals.sample() - first_index] += size_rad_s(arrivals.number());
        }
    }

    // One draw: which half of (0, 1) it lies in is the sign, where in the half the size.
    double size_rad_s(std::uint64_t number) const {
        const double place = 2.0 * sizes.uniform(number) - 1.0;
        const double share = place < 0.0 ? -place : place;
        const double size = smallest_rad_s + share * (largest_rad_s - smallest_rad_s);
        return place < 0.0 ? -size : size;
    }
};

std::unique_ptr<Stage> make(const EffectUse& use) {
    const double per_sample = use["per_hour"] / (seconds_per_hour * use.context().rate_hz);
    return PerAxis<Spikes>::make([&](std::size_t axis) -> std::optional<Spikes> {
        if (!use.acts_on(axis) || per_sample == 0.0) { return std::nullopt; }
        return Spikes{Arrivals(use.stream(axis, 0), per_sample), use.stream(axis, 1),
                      use["smallest_dps"] * rad_per_deg, use["largest_dps"] * rad_per_deg};
    });
}

constexpr EffectParam params[] = {
    {.name = "per_hour",
     .meaning = "mean number an hour, Poisson, on each axis its own",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 1.0,
     .plausible_to = 360.0,
     .most = 1e6},
    {.name = "smallest_dps",
     .meaning = "smallest size",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.3,
     .plausible_to = 5.0},
    {.name = "largest_dps",
     .meaning = "largest size",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.3,
     .plausible_to = 5.0},
};

}  // namespace

constinit const EffectDefinition spikes_effect = {
    .name = "spikes",
    .model =
        "rate plus now and then, for one sample, a size uniform from smallest_dps to largest_dps, of "
        "either sign",
    .source = "",
    .params = params,
    .make = make,
    .noise_only = true,
};

}  // namespace gyrolog
