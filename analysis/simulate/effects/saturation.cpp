#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/recording/recording.hpp"
#include "analysis/simulate/effect_axes.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/rate_map.hpp"

namespace gyrolog {

namespace {

std::unique_ptr<Stage> make_saturation(const EffectUse& use) {
    const double limit_rad_s = use["limit_dps"] * rad_per_deg;
    return make_rate_map(
        use, [=](double rate_rad_s) { return std::clamp(rate_rad_s, -limit_rad_s, limit_rad_s); });
}

constexpr EffectParam saturation_params[] = {
    {.name = "limit_dps",
     .meaning = "largest rate of either sign",
     .range = EffectParam::Range::positive,
     .plausible_from = 245.0,
     .plausible_to = 450.0},
};

constexpr TrialValues limit_values[] = {
    {.param = "limit_dps", .from = 0.002, .to = 0.6, .count = 12, .below_peak = true}};
constexpr std::span<const TrialValues> saturation_trials[] = {limit_values};

// What rounding to a 16-bit code takes from the limit.
constexpr double rounded_rel = 5e-5;
// As close to a clipped sample another one may owe to its noise that it is none.
constexpr std::size_t neighbours = 3;

// Of a clipped sample the noise is unknown, and so is how far the rate went.
void leave_out_clipped(const Recording& recording, const EffectModel& entry, std::vector<bool>& judged) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Column* column = recording.find(gyro_columns[axis]);
        if (!acts_on(entry, axis) || column == nullptr) { continue; }
        const double limit_rad_s = EffectValues(entry, axis)["limit_dps"] * rad_per_deg * (1.0 - rounded_rel);
        for (const Segment& segment : recording.segments) {
            const std::size_t end = segment.first + segment.count;
            for (std::size_t row = segment.first; row < end; ++row) {
                if (std::fabs(column->value(row)) < limit_rad_s) { continue; }
                const std::size_t from = row - std::min(row - segment.first, neighbours);
                const std::size_t to = std::min(row + neighbours + 1, end);
                std::fill(judged.begin() + static_cast<std::ptrdiff_t>(from),
                          judged.begin() + static_cast<std::ptrdiff_t>(to), false);
            }
        }
    }
}

constexpr EffectSignature saturation_signature = {
    .method = EvidenceMethod::saturation,
    .place = PlaceKind::rate,
    .needs_reference = true,
    .trials = saturation_trials,
    .unjudged = leave_out_clipped,
    .words = "The output is clipped at {limit_dps}",
    .noun = "a limit at {limit_dps}",
    .decided_by = "plateaus of both signs up to full scale",
    .force_decided_by = "forces of both signs up to full scale, which gravity alone is not",
};

}  // namespace

constinit const EffectDefinition saturation_effect = {
    .name = "saturation",
    .model = "rate, clipped at +-limit_dps, noise and bias included",
    .source = "",
    .params = saturation_params,
    .make = make_saturation,
    .signature = &saturation_signature,
};

}  // namespace gyrolog
