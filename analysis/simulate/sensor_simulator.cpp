#include "analysis/simulate/sensor_simulator.hpp"

#include <algorithm>

#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/converter.hpp"

namespace gyrolog {

std::optional<std::string> simulation_refusal(const SensorModel& model) {
    for (const EffectModel& effect : model.effects) {
        if (auto refusal = effect_refusal(effect)) { return refusal; }
    }
    return std::nullopt;
}

SensorSimulator::SensorSimulator(const SensorModel& model, double rate_hz, std::uint64_t seed,
                                 std::shared_ptr<const World> world)
    : lsb_rad_s_(converter_steps_rad_s(model)),
      saturation_rad_s_(model.saturation_rad_s),
      world_(std::move(world)),
      stages_(make_chain({model, rate_hz, seed, world_.get()})),
      block_(std::make_unique<SampleBlock>()) {}

const SampleBlock& SensorSimulator::next_block() {
    block_->first_index = next_index_;
    next_index_ += block_samples;
    for (auto& axis : block_->rate_rad_s) { axis.fill(0.0); }
    for (auto& axis : block_->white_rad_s) { axis.fill(0.0); }
    for (const auto& stage : stages_) { stage->apply(*block_); }
    convert();
    return *block_;
}

void SensorSimulator::convert() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lsb_rad_s = lsb_rad_s_[axis];
        if (lsb_rad_s == 0.0) {
            for (double& rate : block_->rate_rad_s[axis]) {
                rate = std::clamp(rate, -saturation_rad_s_, saturation_rad_s_);
            }
            continue;
        }
        Converter(lsb_rad_s, saturation_rad_s_)(block_->rate_rad_s[axis], block_->counts[axis]);
        for (std::size_t i = 0; i < block_samples; ++i) {
            block_->rate_rad_s[axis][i] = block_->counts[axis][i] * lsb_rad_s;
        }
    }
}

}  // namespace gyrolog
