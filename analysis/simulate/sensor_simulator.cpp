#include "analysis/simulate/sensor_simulator.hpp"

#include <algorithm>

#include "analysis/simulate/accelerometer_effect.hpp"
#include "analysis/simulate/chain.hpp"
#include "analysis/simulate/converter.hpp"

namespace gyrolog {

std::optional<std::string> simulation_refusal(const SensorModel& model) {
    for (const EffectModel& effect : model.effects) {
        if (auto refusal = effect_refusal(effect)) { return refusal; }
    }
    if (!model.accelerometer) { return std::nullopt; }
    for (const EffectModel& effect : model.accelerometer->effects) {
        if (const auto refusal = accelerometer_effect_refusal(effect)) {
            return "accelerometer: " + *refusal;
        }
    }
    return std::nullopt;
}

SensorSimulator::SensorSimulator(const SensorModel& model, double rate_hz, std::uint64_t seed,
                                 std::shared_ptr<const World> world)
    : lsb_rad_s_(converter_steps_rad_s(model)),
      saturation_rad_s_(model.saturation_rad_s),
      world_(std::move(world)),
      chain_(make_chain({model, rate_hz, seed, world_.get()})),
      block_(std::make_unique<SampleBlock>()) {}

const SampleBlock& SensorSimulator::next_block() {
    if (announced_) { run_rest(); }
    open(block_samples - next_index_ % block_samples);
    run_clock();
    run_rest();
    return *block_;
}

const SampleBlock& SensorSimulator::announce_sample() {
    if (!announced_) {
        open(1);
        run_clock();
    }
    return *block_;
}

const SampleBlock& SensorSimulator::next_sample() {
    announce_sample();
    run_rest();
    return *block_;
}

void SensorSimulator::open(std::size_t samples) {
    block_->begin = next_index_ % block_samples;
    block_->end = block_->begin + samples;
    block_->first_index = next_index_ - block_->begin;
    next_index_ += samples;
}

void SensorSimulator::run_clock() {
    for (std::size_t i = 0; i < chain_.clock_stages; ++i) { chain_.stages[i]->apply(*block_); }
    announced_ = true;
}

void SensorSimulator::run_rest() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::ranges::fill(block_->slots(block_->rate_rad_s[axis]), 0.0);
        std::ranges::fill(block_->slots(block_->white_rad_s[axis]), 0.0);
    }
    for (std::size_t i = chain_.clock_stages; i < chain_.stages.size(); ++i) {
        chain_.stages[i]->apply(*block_);
    }
    convert();
    announced_ = false;
}

void SensorSimulator::convert() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lsb_rad_s = lsb_rad_s_[axis];
        if (lsb_rad_s == 0.0) {
            for (double& rate : block_->slots(block_->rate_rad_s[axis])) {
                rate = std::clamp(rate, -saturation_rad_s_, saturation_rad_s_);
            }
            continue;
        }
        Converter(lsb_rad_s, saturation_rad_s_)(
            block_->slots(block_->rate_rad_s[axis]),
            std::span(block_->counts[axis]).subspan(block_->begin, block_->end - block_->begin));
        for (std::size_t i = block_->begin; i < block_->end; ++i) {
            block_->rate_rad_s[axis][i] = block_->counts[axis][i] * lsb_rad_s;
        }
    }
}

}  // namespace gyrolog
