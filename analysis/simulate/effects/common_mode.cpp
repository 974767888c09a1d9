#include <algorithm>
#include <cmath>

#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class CommonNoise final : public Stage {
public:
    explicit CommonNoise(const EffectUse& use)
        : stream_(use.stream(0)), is_part_of_white_(use["part_of_white"] != 0.0) {
        constexpr std::array<const char*, 3> gains = {"gain_x", "gain_y", "gain_z"};
        const double sd_rad_s = use["N_dps_per_sqrt_hz"] * rad_per_deg * std::sqrt(use.context().rate_hz);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (use.acts_on(axis)) { sd_rad_s_[axis] = sd_rad_s * use[gains[axis]]; }
        }
    }

    void apply(SampleBlock& block) override {
        BlockValues draws;  // NOLINT(cppcoreguidelines-pro-type-member-init)
        stream_.normals(block.first(), block.slots(draws));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double own = own_share(block.white_sd_rad_s[axis], sd_rad_s_[axis]);
            block.white_sd_rad_s[axis] = std::hypot(own * block.white_sd_rad_s[axis], sd_rad_s_[axis]);
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.white_rad_s[axis][i] = own * block.white_rad_s[axis][i] + sd_rad_s_[axis] * draws[i];
            }
        }
    }

private:
    // Of the axis' own noise, that stays beside the common one.
    double own_share(double white_sd_rad_s, double common_sd_rad_s) const {
        if (!is_part_of_white_ || common_sd_rad_s == 0.0) { return 1.0; }
        const double common = std::min(common_sd_rad_s / white_sd_rad_s, 1.0);
        return std::sqrt(1.0 - common * common);
    }

    RandomStream stream_;
    bool is_part_of_white_;
    Vector3 sd_rad_s_{};
};

std::unique_ptr<Stage> make_common_mode(const EffectUse& use) { return std::make_unique<CommonNoise>(use); }

constexpr EffectParam gain(std::string_view name) {
    return {.name = name,
            .meaning = "share of this axis; below zero in opposite phase",
            .plausible_from = 0.5,
            .plausible_to = 1.0,
            .otherwise = 1.0};
}

constexpr EffectParam common_mode_params[] = {
    {.name = "N_dps_per_sqrt_hz",
     .meaning = "density of the common noise, two-sided",
     .range = EffectParam::Range::not_negative,
     .plausible_from = 0.0003,
     .plausible_to = 0.01},
    gain("gain_x"),
    gain("gain_y"),
    gain("gain_z"),
    {.name = "part_of_white",
     .meaning = "1: it is part of the white noise that the axis has; 0: it is added to that",
     .range = EffectParam::Range::yes_no,
     .plausible_from = 0.0,
     .plausible_to = 1.0,
     .otherwise = 0.0},
};

void common_mode_spectrum(std::span<const double> /*f_hz*/, double /*rate_hz*/, const EffectValues& effect,
                          std::span<SpectralParts> parts) {
    if (effect["part_of_white"] != 0.0) { return; }
    constexpr std::array<const char*, 3> gains = {"gain_x", "gain_y", "gain_z"};
    const double rad_per_sqrt_s = effect["N_dps_per_sqrt_hz"] * rad_per_deg * effect[gains[effect.axis()]];
    for (SpectralParts& part : parts) { part.added_white += rad_per_sqrt_s * rad_per_sqrt_s; }
}

constexpr EffectSignature common_mode_signature = {
    .method = EvidenceMethod::shared_noise,
    .place = PlaceKind::structure,
    .structure = "cross_axis",
    .spectrum = common_mode_spectrum,
    .words = "The axes share white noise of {N_dps_per_sqrt_hz}.",
    .noun = "white noise of {N_dps_per_sqrt_hz} in common to the axes",
    .decided_by = "a recording at rest of all three axes, with another supply",
};

}  // namespace

constinit const EffectDefinition common_mode_effect = {
    .name = "common_mode",
    .model =
        "one white noise of density N_dps_per_sqrt_hz^2, added to each axis times its gain; with "
        "part_of_white "
        "the axis' own white noise is less by as much power, so that the axis has as much as before",
    .source = "",
    .params = common_mode_params,
    .make = make_common_mode,
    .noise_only = true,
    .signature = &common_mode_signature,
};

}  // namespace gyrolog
