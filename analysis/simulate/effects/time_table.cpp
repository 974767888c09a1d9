#include <array>
#include <memory>
#include <utility>

#include "analysis/simulate/effects/effects.hpp"

namespace gyrolog {

namespace {

class BiasOverTime final : public Stage {
public:
    explicit BiasOverTime(const EffectUse& use) : bias_dps_(use.course()) {
        for (std::size_t axis = 0; axis < 3; ++axis) { acts_on_[axis] = use.acts_on(axis); }
    }

    void apply(SampleBlock& block) override {
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const double bias_rad_s = bias_dps_(block.world_s[i]) * rad_per_deg;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (acts_on_[axis]) { block.rate_rad_s[axis][i] += bias_rad_s; }
            }
        }
    }

private:
    Course bias_dps_;
    std::array<bool, 3> acts_on_{};
};

std::unique_ptr<Stage> make_time_table(const EffectUse& use) { return std::make_unique<BiasOverTime>(use); }

constexpr EffectSignature time_table_signature = {
    .method = EvidenceMethod::described,
    .place = PlaceKind::time,
    .event = true,
    .words = "The output follows a course over time that was described.",
    .noun = "a course over time",
};

}  // namespace

constinit const EffectDefinition time_table_effect = {
    .name = "time_table",
    .model = "rate + bias_dps(t), straight between the table's points",
    .source = "",
    .params = {},
    .make = make_time_table,
    .table = EffectTable{.at = "t_s",
                         .value = "bias_dps",
                         .meaning = "added to the bias, by time from the first sample; beyond the table as "
                                    "at its ends"},
    .signature = &time_table_signature,
};

}  // namespace gyrolog
