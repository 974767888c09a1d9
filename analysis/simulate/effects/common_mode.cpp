#include <cmath>

#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class CommonNoise final : public Stage {
public:
    explicit CommonNoise(const EffectUse& use) : stream_(use.stream(0)) {
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
            double& sd_rad_s = block.white_sd_rad_s[axis];
            sd_rad_s = std::sqrt(sd_rad_s * sd_rad_s + sd_rad_s_[axis] * sd_rad_s_[axis]);
            for (std::size_t i = block.begin; i < block.end; ++i) {
                block.white_rad_s[axis][i] += sd_rad_s_[axis] * draws[i];
            }
        }
    }

private:
    RandomStream stream_;
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
};

void common_mode_spectrum(std::span<const double> /*f_hz*/, double /*rate_hz*/, const EffectValues& effect,
                          std::span<SpectralParts> parts) {
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
    .model = "one white noise of density N_dps_per_sqrt_hz^2, added to each axis times its gain",
    .source = "",
    .params = common_mode_params,
    .make = make_common_mode,
    .noise_only = true,
    .signature = &common_mode_signature,
};

}  // namespace gyrolog
