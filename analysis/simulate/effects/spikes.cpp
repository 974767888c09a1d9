#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/noise/noise_model.hpp"
#include "analysis/recording/recording.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/effects/arrivals.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/per_axis.hpp"

namespace gyrolog {

namespace {

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

std::unique_ptr<Stage> make_spikes(const EffectUse& use) {
    const double per_sample = use["per_hour"] / (s_per_h * use.context().rate_hz);
    return PerAxis<Spikes>::make([&](std::size_t axis) -> std::optional<Spikes> {
        if (!use.acts_on(axis) || per_sample == 0.0) { return std::nullopt; }
        return Spikes{Arrivals(use.stream(axis, 0), per_sample), use.stream(axis, 1),
                      use["smallest_dps"] * rad_per_deg, use["largest_dps"] * rad_per_deg};
    });
}

constexpr EffectParam spikes_params[] = {
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

// How far a sample is from the middle between its neighbours; at the ends, and between holes, as if there
// were none.
double off_neighbours(const Column& column, std::size_t row) {
    return column.value(row) - 0.5 * (column.value(row - 1) + column.value(row + 1));
}

// Standard deviation of the samples' white noise, from every n-th sample's mean distance to its neighbours.
// Spikes are left out in a second round.
double white_sd(const Column& column) {
    constexpr std::size_t enough = 50'000;
    constexpr double sd_per_mean = 1.2533;     // of a normal distribution: sqrt(pi / 2)
    constexpr double of_differences = 1.2247;  // sqrt(1 + 1 / 2)
    const std::size_t every = std::max<std::size_t>(1, column.size() / enough);
    double sd = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 3; ++round) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t row = 1; row + 1 < column.size(); row += every) {
            const double off = std::fabs(off_neighbours(column, row));
            if (off > 6.0 * of_differences * sd) { continue; }
            sum += off;
            count += 1.0;
        }
        sd = count > 0.0 ? sd_per_mean / of_differences * sum / count : 0.0;
    }
    return sd;
}

double median_around(const Column& column, std::size_t row) {
    constexpr std::size_t reach = 4;
    std::array<double, 2 * reach> near{};
    std::size_t count = 0;
    for (std::size_t i = row < reach ? 0 : row - reach; i < std::min(row + reach + 1, column.size()); ++i) {
        if (i != row) { near[count++] = column.value(i); }
    }
    const auto end = near.begin() + static_cast<std::ptrdiff_t>(count);
    const auto middle = near.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(near.begin(), middle, end);
    return *middle;
}

// Samples that are more likely a spike than noise: beyond half the smallest size, and beyond what the noise
// reaches some twice in a million samples.
void unjudged_spikes(const Recording& recording, const EffectModel& entry, std::vector<bool>& judged) {
    constexpr double noise_sigma = 5.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Column* column = recording.find(gyro_columns[axis]);
        if (column == nullptr || column->unit != "rad/s") { continue; }
        if (!acts_on(entry, axis)) { continue; }
        const double limit_rad_s = std::max(noise_sigma * white_sd(*column),
                                            0.5 * EffectValues(entry)["smallest_dps"] * rad_per_deg);
        for (std::size_t row = 1; row + 1 < column->size(); ++row) {
            // A first look, cheap, which hardly any spike fails.
            if (std::fabs(off_neighbours(*column, row)) < 0.6 * limit_rad_s) { continue; }
            if (std::fabs(column->value(row) - median_around(*column, row)) > limit_rad_s) {
                judged[row] = false;
            }
        }
    }
}

constexpr EffectSignature spikes_signature = {
    .method = EvidenceMethod::outliers,
    .place = PlaceKind::structure,
    .structure = "isolated_samples",
    .unjudged = unjudged_spikes,
    .words = "Single samples are off by {smallest_dps} to {largest_dps}, {per_hour}.",
    .noun = "spikes of {smallest_dps} to {largest_dps}",
    .decided_by = "a longer recording at rest, of raw samples",
};

}  // namespace

constinit const EffectDefinition spikes_effect = {
    .name = "spikes",
    .model =
        "rate plus now and then, for one sample, a size uniform from smallest_dps to largest_dps, of "
        "either sign",
    .source = "",
    .params = spikes_params,
    .make = make_spikes,
    .noise_only = true,
    .signature = &spikes_signature,
};

}  // namespace gyrolog
