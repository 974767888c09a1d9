#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class Misalignment final : public Stage {
public:
    explicit Misalignment(const EffectUse& use) : gain_{use["from_x"], use["from_y"], use["from_z"]} {
        for (std::size_t axis = 0; axis < 3; ++axis) { acts_[axis] = use.acts_on(axis); }
    }

    void apply(SampleBlock& block) override {
        if (!block.moving) { return; }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t from = 0; from < 3 && acts_[axis]; ++from) {
                if (from == axis) { continue; }
                for (std::size_t i = block.begin; i < block.end; ++i) {
                    block.rate_rad_s[axis][i] += gain_[from] * block.true_rate_rad_s[from][i];
                }
            }
        }
    }

private:
    Vector3 gain_;
    std::array<bool, 3> acts_{};
};

std::unique_ptr<Stage> make_misalignment(const EffectUse& use) { return std::make_unique<Misalignment>(use); }

constexpr EffectParam gain_from(std::string_view name, std::string_view meaning) {
    return {
        .name = name, .meaning = meaning, .plausible_from = -0.02, .plausible_to = 0.02, .otherwise = 0.0};
}

constexpr EffectParam misalignment_params[] = {
    gain_from("from_x", "gain of the true rate about x; the x axis itself is left alone"),
    gain_from("from_y", "gain of the true rate about y; the y axis itself is left alone"),
    gain_from("from_z", "gain of the true rate about z; the z axis itself is left alone"),
};

constexpr std::string_view misalignment_linear[] = {"from_x", "from_y", "from_z"};

constexpr EffectSignature misalignment_signature = {
    .method = EvidenceMethod::response,
    .place = PlaceKind::rate,
    .needs_reference = true,
    .linear = misalignment_linear,
    .words = "The axis picks up rates about other axes: {from_x} of x, {from_y} of y, {from_z} of z",
    .noun = "cross-axis terms",
    .decided_by = "plateaus of several rates about one axis after the other",
    .force_words = "The axis picks up forces along other axes: {from_x} of x, {from_y} of y, {from_z} of z",
    .force_decided_by = "rests with each axis upward, downward and at several angles between",
};

}  // namespace

constinit const EffectDefinition misalignment_effect = {
    .name = "misalignment",
    .model = "w_i + sum over j != i of from_j W_j, W the true rate",
    .source = "IEEE 528-2019 (input-axis misalignment)",
    .params = misalignment_params,
    .make = make_misalignment,
    .signature = &misalignment_signature,
};

}  // namespace gyrolog
