#include "host/app/live_allan.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "analysis/noise/walk_knowledge.hpp"
#include "host/app/quantity.hpp"

namespace gyrolog {
namespace {

bool same_samples(const glp_config& a, const glp_config& b) {
    return a.rate_mHz == b.rate_mHz && a.gyro_ndps_per_lsb == b.gyro_ndps_per_lsb && a.dlpf_hz == b.dlpf_hz &&
           a.decimation == b.decimation;
}

// K by the fit to the curve; what there is to know about it by the bound that `analyze` comes near to.
LiveAxis judge(const RunningAllan& running, const glp_config& config) {
    const double rate_hz = config.rate_mHz * 1e-3;
    LiveAxis axis;
    RunningAllan::Described described = running.describe(rate_hz, config.gyro_ndps_per_lsb * 1e-9);
    axis.curve = std::move(described.curve);
    NoiseCoefficients noise = coefficients_of(described.laws, rate_hz);
    axis.length_s = static_cast<double>(running.samples()) / rate_hz;
    axis.walk_seen = noise.K_rad_per_s_sqrt_s > 0.0;
    if (!axis.walk_seen) {
        noise.K_rad_per_s_sqrt_s = walk_seen_from(noise, rate_hz, axis.length_s).value_or(0.0);
    }
    axis.K = noise.K_rad_per_s_sqrt_s;
    if (!axis.walk_seen) { return axis; }
    axis.K_relative_sd = walk_relative_sd(noise, rate_hz, axis.length_s);
    if (const auto needed_s = length_to_know_walk_s(noise, rate_hz, walk_wanted_sd)) {
        axis.still_needed_s = std::max(0.0, *needed_s - axis.length_s);
    }
    return axis;
}

}  // namespace

void LiveAllan::on_start() {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(started_, true)) { config_.reset(); }
}

void LiveAllan::begin(const glp_config& config) {
    running_ = {};
    config_ = config;
}

void LiveAllan::on_samples(const glp_frame& /*frame*/, const glp_samples& samples, const glp_config& config) {
    if ((samples.layout & glp_layout_gyro) == 0 || config.rate_mHz == 0) { return; }
    const std::lock_guard lock(mutex_);
    if (!config_ || !same_samples(*config_, config)) { begin(config); }
    for (std::size_t i = 0; i < samples.count; ++i) {
        const auto index = static_cast<std::int64_t>(samples.first_index + i);
        for (std::size_t axis = 0; axis < running_.size(); ++axis) {
            running_[axis].take(index, glp_sample_field(&samples, i, axis));
        }
    }
}

std::uint64_t LiveAllan::samples() const {
    const std::lock_guard lock(mutex_);
    return config_ ? running_.front().samples() : 0;
}

std::array<LiveAxis, 3> LiveAllan::axes() const {
    std::array<RunningAllan, 3> running;
    std::optional<glp_config> config;
    {
        const std::lock_guard lock(mutex_);
        running = running_;
        config = config_;
    }
    std::array<LiveAxis, 3> axes;
    constexpr std::uint64_t samples_min = 64;  // fewer are no curve yet
    if (!config || running.front().samples() < samples_min) { return axes; }
    for (std::size_t i = 0; i < axes.size(); ++i) { axes[i] = judge(running[i], *config); }
    return axes;
}

std::string walk_text(const LiveAxis& axis) {
    if (axis.curve.points.empty()) { return "K: too early to say"; }
    if (!axis.walk_seen) {
        // No time until it is known: that of the largest walk that may be there is seconds, and says nothing.
        return axis.K > 0.0 ? fmt::format("K not seen, < {:.2g} dps*sqrt(Hz)", axis.K) : "K not seen";
    }
    std::string text = fmt::format("K {:.2g} dps*sqrt(Hz)", axis.K);
    if (axis.K_relative_sd && *axis.K_relative_sd < 1.0) {
        text += fmt::format(" ±{:.0f} %", 100.0 * *axis.K_relative_sd);
    }
    if (!axis.still_needed_s) { return text; }
    return text + (*axis.still_needed_s > 0.0
                       ? fmt::format(", about {} more until ±20 %", format_duration(*axis.still_needed_s))
                       : ", known to ±20 %");
}

}  // namespace gyrolog
