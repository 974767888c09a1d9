#include "analysis/simulate/stepped_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/simulate/chain.hpp"

namespace gyrolog {
namespace {

bool is_finite(const WorldInstant& now) {
    const auto all_finite = [](const Vector3& v) {
        return std::ranges::all_of(v, [](double x) { return std::isfinite(x); });
    };
    return std::isfinite(now.t_s) && !std::isinf(now.temperature_C) && all_finite(now.rate_rad_s) &&
           all_finite(now.specific_force_m_s2);
}

}  // namespace

SteppedSensor::SteppedSensor(const SensorModel& model, double rate_hz, std::uint64_t seed)
    : rate_hz_(rate_hz),
      true_rate_hz_(true_rate_hz(model, rate_hz)),
      world_(std::make_shared<SteppedWorld>(steps_kept)),
      simulator_(model, rate_hz, seed, world_) {}

SteppedSensor::Step SteppedSensor::step(const WorldInstant& now) {
    if (!is_finite(now)) { return Step::not_finite; }
    if (world_->empty()) {
        start_s_ = now.t_s;
    } else if (now.tells_temperature() != world_->has_temperature()) {
        return Step::temperature_changed;
    }
    WorldInstant since_start = now;
    since_start.t_s = now.t_s - start_s_;
    if (!world_->empty() && since_start.t_s <= world_->now_s()) { return Step::not_later; }
    world_->add(since_start);
    return Step::taken;
}

SteppedSensor::Take SteppedSensor::take(SteppedSample& sample) {
    constexpr double early_periods = 1e-3;
    if (world_->empty()) { return Take::none; }
    for (;;) {
        const SampleBlock& next = simulator_.announce_sample();
        const std::size_t i = next.begin;
        const double due_s = std::max(static_cast<double>(next.first()) / true_rate_hz_, next.world_s[i]);
        if (due_s > world_->now_s() + early_periods / true_rate_hz_) { return Take::none; }
        if (!world_->remembers(next.world_s[i])) { return Take::forgotten; }
        const SampleBlock& made = simulator_.next_sample();
        if (made.lost[i]) { continue; }
        sample.index = made.first();
        sample.stamp_s = start_s_ + made.stamp_s[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sample.rate_rad_s[axis] = made.rate_rad_s[axis][i];
            sample.counts[axis] = made.counts[axis][i];
        }
        sample.temperature_C = made.temperature_C[i];
        return Take::sample;
    }
}

}  // namespace gyrolog
