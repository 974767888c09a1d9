#include "analysis/simulate/sensor_simulator.hpp"

#include <algorithm>

#include "analysis/simulate/converter.hpp"
#include "analysis/simulate/effects/effects.hpp"
#include "analysis/simulate/stages/stages.hpp"

namespace gyrolog {

namespace {

// In the order of the physics: temperature, then what adds to the rate. Effects of the model follow.
constexpr std::array<StageMaker, 7> sensor_stages = {
    make_temperature,      make_bias,      make_white_noise,        make_flicker_noise,
    make_rate_random_walk, make_rate_ramp, make_angle_quantisation,
};

}  // namespace

std::optional<std::string> simulation_refusal(const SensorModel& model) {
    for (const EffectModel& effect : model.effects) {
        if (auto refusal = effect_refusal(effect)) { return refusal; }
    }
    return std::nullopt;
}

SensorSimulator::SensorSimulator(const SensorModel& model, double rate_hz, std::uint64_t seed)
    : lsb_rad_s_(model.lsb_rad_s),
      saturation_rad_s_(model.saturation_rad_s),
      block_(std::make_unique<SampleBlock>()) {
    const StageContext context{model, rate_hz, seed};
    for (const StageMaker make : sensor_stages) {
        if (auto stage = make(context)) { stages_.push_back(std::move(stage)); }
    }
    for (const EffectModel& effect : model.effects) {
        if (auto stage = find_effect(effect.effect)->make(context, effect)) {
            stages_.push_back(std::move(stage));
        }
    }
}

const SampleBlock& SensorSimulator::next_block() {
    block_->first_index = next_index_;
    next_index_ += block_samples;
    for (auto& axis : block_->rate_rad_s) { axis.fill(0.0); }
    for (const auto& stage : stages_) { stage->apply(*block_); }
    convert();
    return *block_;
}

void SensorSimulator::convert() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (lsb_rad_s_ == 0.0) {
            for (double& rate : block_->rate_rad_s[axis]) {
                rate = std::clamp(rate, -saturation_rad_s_, saturation_rad_s_);
            }
            continue;
        }
        Converter(lsb_rad_s_, saturation_rad_s_)(block_->rate_rad_s[axis], block_->counts[axis]);
        for (std::size_t i = 0; i < block_samples; ++i) {
            block_->rate_rad_s[axis][i] = block_->counts[axis][i] * lsb_rad_s_;
        }
    }
}

}  // namespace gyrolog
