#include <utility>

#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/effects/white_noise_gain.hpp"

namespace gyrolog {

namespace {

struct LevelOverTime {
    Course factor;

    double operator()(const SampleBlock& block, std::size_t i) const { return factor(block.world_s[i]); }
};

std::unique_ptr<Stage> make_level_table(const EffectUse& use) {
    return std::make_unique<WhiteNoiseGain<LevelOverTime>>(use, LevelOverTime{use.course()});
}

WhiteGain level_table_white_gain(const EffectUse& use) {
    return [factor = use.course()](double time_s, double) { return factor(time_s); };
}

constexpr EffectSignature level_table_signature = {
    .method = EvidenceMethod::described,
    .place = PlaceKind::time,
    .event = true,
    .white_gain = level_table_white_gain,
    .words = "The white noise's standard deviation follows a course over time that was described.",
    .noun = "a course of the white noise's standard deviation over time",
};

}  // namespace

constinit const EffectDefinition level_table_effect = {
    .name = "level_table",
    .model = "white noise times factor(t), straight between the table's points",
    .source = "",
    .params = {},
    .make = make_level_table,
    .table = EffectTable{.at = "t_s",
                         .value = "factor",
                         .meaning = "of the standard deviation, by time from the first sample; beyond the "
                                    "table as at its ends",
                         .positive = true},
    .signature = &level_table_signature,
};

}  // namespace gyrolog
